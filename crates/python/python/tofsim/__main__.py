"""The command `tofsim`."""

import sys

from ._tofsim import main as run


def main() -> None:
    """Does what the command line asks for."""
    sys.exit(run(sys.argv))


if __name__ == "__main__":
    main()
