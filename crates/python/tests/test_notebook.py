"""The notebook of the documents runs from its begin to its end."""

from pathlib import Path

import nbformat
from conftest import ROOT
from nbclient import NotebookClient


def test_the_notebook_runs(tmp_path: Path) -> None:
    notebook = nbformat.read(ROOT / "docs" / "notebook.ipynb", as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs for cell in cells), "it is kept without outputs"
    client = NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    shown = [output.get("data", {}) for cell in cells for output in cell.outputs]
    kinds = [kind for data in shown for kind in data]
    assert kinds.count("image/png") == 3, "a trace, a distribution and the accuracy"
    assert "image/svg+xml" in kinds and "text/html" in kinds
    assert "image/png" in cells[-1].outputs[-1]["data"]
