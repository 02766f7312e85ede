//! The command line: one file per subcommand, each with its `Args` and `run`.
