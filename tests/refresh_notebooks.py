"""Run the notebooks and keep what they show, small and without traces of the run.

    python -m tests.refresh_notebooks [NOTEBOOK...]

Needs the extra `test`.
"""

import base64
import io
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import nbformat
from jupyter_client.manager import AsyncKernelManager
from jupyter_core.utils import run_sync
from nbclient import NotebookClient
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell
from PIL import Image

NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
WIDEST_PX = 760
COLOURS = (256, 64, 32)  # as many as leave a picture small
PICTURE_BYTES = 25_000


# no name, no module of the project and no setting of figures is left of another notebook
FRESH = """
import os, sys
os.chdir("{folder}")
%reset -f
import sys
for name in [name for name in sys.modules if name.partition(".")[0] in ("odometry", "terrain")]:
    del sys.modules[name]
if "matplotlib" in sys.modules:
    sys.modules["matplotlib"].rcdefaults()
%reset -f
"""


@contextmanager
def shared_kernel() -> Iterator[AsyncKernelManager]:
    """A kernel for several notebooks, which the first one starts."""
    kernel = AsyncKernelManager(kernel_name="python3")
    try:
        yield kernel
    finally:
        if kernel.has_kernel:
            run_sync(kernel.shutdown_kernel)(now=True)


def executed(notebook: Path, kernel: AsyncKernelManager) -> NotebookNode:
    """The notebook with what it shows when it is run in an empty folder."""
    book = nbformat.read(notebook, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        book.cells.insert(0, new_code_cell(FRESH.format(folder=folder)))
        client = NotebookClient(book, km=kernel, timeout=600, record_timing=False)
        try:
            client.execute()
        finally:
            if client.kc is not None:
                client.kc.stop_channels()
    del book.cells[0]
    for cell in book.cells:
        cell.metadata = NotebookNode()
        if cell.cell_type == "code":
            cell.execution_count = None
            cell.outputs = [tidied(output) for output in joined(cell.outputs)]
    book.metadata = NotebookNode(
        kernelspec={"display_name": "Python 3", "language": "python", "name": "python3"},
        language_info={"name": "python"},
    )
    return book


def joined(outputs: list[NotebookNode]) -> list[NotebookNode]:
    """Neighbouring pieces of one stream as one: how a run cuts them is chance."""
    whole: list[NotebookNode] = []
    for output in outputs:
        if whole and output.output_type == "stream" and output.get("name") == whole[-1].get("name"):
            whole[-1].text += output.text
        else:
            whole.append(output)
    return whole


def tidied(output: NotebookNode) -> NotebookNode:
    """Without the count of executions, and with a small picture."""
    if "execution_count" in output:
        output.execution_count = None
    if "image/png" in output.get("data", {}):
        output.data["image/png"] = small(output.data["image/png"])
    return output


def small(encoded: str) -> str:
    """A picture with few colours, no wider than a page."""
    picture = Image.open(io.BytesIO(base64.b64decode(encoded))).convert("RGB")
    if picture.width > WIDEST_PX:
        height = round(picture.height * WIDEST_PX / picture.width)
        picture = picture.resize((WIDEST_PX, height), Image.Resampling.LANCZOS)
    for colours in COLOURS:
        file = io.BytesIO()
        few = picture.quantize(colours, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
        few.save(file, "PNG", optimize=True)
        if file.tell() <= PICTURE_BYTES:
            break
    return base64.b64encode(file.getvalue()).decode() + "\n"


if __name__ == "__main__":
    with shared_kernel() as kernel:
        for notebook in map(Path, sys.argv[1:] or sorted(NOTEBOOKS.glob("*.ipynb"))):
            nbformat.write(executed(notebook, kernel), notebook)
