"""hidden_effect.py OUT.ipynb - a notebook of its own: simulate with a hidden effect, diagnose, add, look at the ladder, open the seal.

Exit 1 where a cell fails, the added model is shown without its ladder, the error does not fall, or the seal holds something else.
"""

import sys

import nbclient
import nbformat

CELLS = (
    'import traction\nlog = traction.simulate("demo_sand", hide=3, seed=3)\nlog',
    'told = traction.diagnose("rover_sand", log)\ntold',
    'added = traction.add("rover_sand", told.verdict.effects[0], log)\nadded',
    "added.model",
    "print(*(f'{step.label}: {step.heldout:.2f}' for step in added.ladder), sep='\\n')\n"
    "assert added.ladder[-1].heldout < added.ladder[0].heldout",
    "import json\nhidden = json.loads(log.run.seal)['effects'][0]['name']\nprint('hidden:', hidden, '- named:', *told.verdict.effects)\n"
    "assert hidden in told.verdict.effects",
)

book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in CELLS])
nbclient.NotebookClient(book, timeout=None, kernel_name="python3").execute()
nbformat.write(book, sys.argv[1])
for cell in book.cells:
    for output in cell.outputs:
        print(output.get("text") or output.data.get("text/plain", ""), end="\n" if "data" in output else "")
if not any("ladder" in output.get("data", {}).get("text/html", "") for cell in book.cells for output in cell.outputs):
    sys.exit("no cell shows a ladder")
