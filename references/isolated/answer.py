"""Answer one request inside an isolated environment: ``python -I answer.py MODULE``, JSON on standard input and output.

Only this file and the module beside it run there; they import nothing but the code and NumPy. The module has
``solve(request)``, which returns the answer. Whatever it raises becomes ``{"error": …}``.
"""

import importlib
import json
import os
import sys
from pathlib import Path


def main(module):
    """Answer the request with a module of this folder."""
    sys.path.append(str(Path(__file__).parent))  # last: a file here may have the name of a package
    request = json.load(sys.stdin)
    reply = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # keep the code's prints out of the answer
    try:
        answer = importlib.import_module(module).solve(request)
    except Exception as error:  # report whatever the code raises
        answer = {"error": f"{type(error).__name__}: {' '.join(str(error).split())}"}
    reply.write(json.dumps(answer) + "\n")
    reply.flush()


if __name__ == "__main__":
    main(sys.argv[1])
