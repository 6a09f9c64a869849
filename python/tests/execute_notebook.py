"""Executes a notebook where it lies, and writes it with its outputs: execute_notebook.py NOTEBOOK OUTPUT."""

from __future__ import annotations

import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient


def main(source: Path, output: Path) -> None:
    """Raises the error of the first cell that has one."""
    notebook = nbformat.read(source, as_version=4)
    client = NotebookClient(
        notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(source.parent)}}
    )
    client.execute()
    nbformat.write(notebook, output)
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    pictures = sum("image/png" in output.get("data", {}) for output in outputs)
    asked = sum("figures." in cell.source or "az.plot_" in cell.source for cell in notebook.cells if cell.cell_type == "code")
    if pictures < asked:
        sys.exit(f"{source}: {pictures} pictures are shown where {asked} are asked for")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
