"""What foreign codes do wrong, as a table: each line becomes a module of its own with a code that does it at one moment."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from southwell.core.effects import ALL_EFFECTS
from southwell.core.modes import Modes
from southwell.references.protocol.interface import BladeAdapter

When = Literal["import", "version", "unsupported", "solve"]
Lost = Literal["none", "one", "rest", "all"]
"""Of three runs, the second of which provokes the deed: none; the second; it and the third; all."""

TEMPLATE = """
import builtins, ctypes, json, locale, os, signal, subprocess, sys, threading, time
import numpy
from southwell.references.protocol.interface import CodeError
from southwell.tests.support.misdeeds import Base, good
{at_import}
class Code(Base):
    def version(self):
        {at_version}
        return "1.0"
    def unsupported(self, blade):
        {at_unsupported}
        return None
    def modes(self, blade, omega, elements, count):
        if omega == 2.0:
            {at_solve}
        return good(omega, elements, count)
CODE = Code()
"""


class Base(BladeAdapter):
    """Declarations that are right."""

    name = "misdeed"
    title = "Misdeed"
    effects = ALL_EFFECTS
    levels = (10, 20)
    order = 2
    hint = "pip install manners"


def good(omega: float, elements: int, count: int) -> Modes:
    """An answer that nothing is wrong with."""
    return Modes(omega, np.arange(1.0, count + 1), np.full((count, 21, 4), 0.5 + 0.25j), elements)


@dataclass(frozen=True)
class Misdeed:
    """One line of the table: what is done when, which runs may be lost, what the reason must say, and the time limit, s."""

    name: str
    when: When
    source: str
    lost: Lost
    reason: str = ""
    seconds: float = 60.0

    def write(self, folder: Path) -> str:
        """Its module, in a folder; the import path of its code."""
        moments: dict[str, str] = dict.fromkeys(("at_import", "at_version", "at_unsupported", "at_solve"), "pass")
        moments[f"at_{self.when}"] = self.source
        module = f"misdeed_{self.when}_{self.name}"
        (folder / f"{module}.py").write_text(TEMPLATE.format(**moments), encoding="utf-8")
        return f"{module}:CODE"


ENDS = {
    "exit_0": ("os._exit(0)", "exit status 0"),
    "exit_1": ("os._exit(1)", "exit status 1"),
    "segfault": ("ctypes.string_at(0)", "SIGSEGV"),
    "abort": ("os.abort()", "SIGABRT"),
    "real_time_signal": ("os.kill(os.getpid(), 40)", "signal 40"),
    "kills_itself": ("os.kill(os.getpid(), signal.SIGKILL)", "SIGKILL"),
    "kills_its_group": ("os.killpg(0, signal.SIGKILL)", "SIGKILL"),
    "kills_its_parent": ("os.kill(os.getppid(), signal.SIGKILL); time.sleep(600)", "SIGKILL"),
    "closes_everything": ("os.closerange(0, 400)", "ended with"),
    "dies_in_latin_1": ("os.write(2, b'caf\\xe9 \\x1b[31m\\n'); os._exit(7)", "exit status 7: caf"),
    "stack_overflow": (
        "sys.setrecursionlimit(10**9); f = lambda x: f.__call__(x); [None for _ in map(f, [0])]", "ended with"),
}  # fmt: skip
"""What ends the process at once."""

HANGS = {
    "hang": "time.sleep(600)",
    "hang_with_child": "subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)']); time.sleep(600)",
    "hang_deaf": "[signal.signal(n, signal.SIG_IGN) for n in (1, 2, 3, 15)]; time.sleep(600)",
    "stops_itself": "os.kill(os.getpid(), signal.SIGSTOP)",
    "floods_stdout": "exec('while True: os.write(1, bytes(65536))')",
    "floods_stderr": "exec('while True: os.write(2, bytes(65536))')",
}
"""What never ends."""

HANG_SECONDS = 4.0
"""Time limit of what never ends, s; all else has a limit that no busy machine reaches."""

RAISES = {
    "sys_exit": ("sys.exit(0)", "SystemExit: 0"),
    "raises": ("raise ValueError('no licence\\nat all')", "ValueError: no licence at all"),
    "raises_base": ("raise BaseException('anything')", "BaseException: anything"),
    "interrupts": ("raise KeyboardInterrupt", "KeyboardInterrupt"),
    "recursion": ("f = lambda: f(); f()", "RecursionError"),
    "raises_mute": (
        "raise type('Mute', (Exception,), {'__str__': lambda s: 1 / 0})()", "Mute: its message raised ZeroDivisionError"),
    "surrogate": ("raise ValueError('\\ud800')", "ValueError: ?"),
    "endless_message": ("raise ValueError('x' * 10**7)", "xxx…"),
    "terabytes": ("numpy.ones(2**40)", "MemoryError"),
}  # fmt: skip
"""What is an exception."""

HARMLESS = {
    "changes_folder": "os.chdir('/')",
    "forks_twice": "os.fork() or (os.setsid(), os.fork() or time.sleep(600), os._exit(0))",
    "leaves_children": "[subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)']) for _ in range(3)]",
    "leaves_a_thread": "threading.Thread(target=time.sleep, args=(600,)).start()",
    "prints": "print('{\"run\": 0}', flush=True); os.write(1, b'\\xff\\n'); os.write(2, bytes(10**7))",
    "reads": "sys.stdin.read(); os.read(0, 1)",
    "no_environment": "os.environ.clear()",
    "another_locale": "locale.setlocale(locale.LC_ALL, 'C'); os.environ['LC_ALL'] = 'C'",
    "signal_handlers": "[signal.signal(n, signal.SIG_IGN) for n in (2, 15, 17)]",
    "closes_stdout": "sys.stdout.close()",
    "writes_random_py": "open('random.py', 'w').write('import os; os._exit(9)')",
}
"""What nobody else may notice."""

EVERYWHERE = "exec('for n in range(3, 400):\\n try: os.write(n, b\"hello\\\\n\")\\n except OSError: pass')"

PIPES = {
    "bytes_everywhere": (EVERYWHERE, "not an answer: b'hello'"),
    "patches_json": ("json.dumps = lambda *a, **k: '[1, 2]'", "not an answer: b'[1, 2]'"),
    "endless_line": ("json.dumps = lambda *a, **k: 'x' * 2**25", "more than 16 MiB"),
    "deep_json": ("json.dumps = lambda *a, **k: '[' * 10**6", "not an answer"),
    "eats_memory": ("x = [b'x' * 2**26 for _ in range(40)]; time.sleep(600)", "GiB of memory"),
}  # fmt: skip
"""What spoils the answers' pipe, or is stopped."""


def _table() -> tuple[Misdeed, ...]:
    out: list[Misdeed] = []
    for name, (source, reason) in ENDS.items():
        out += [Misdeed(name, "import", source, "all", reason), Misdeed(name, "solve", source, "rest", reason)]
    for name, source in HANGS.items():
        out.append(Misdeed(name, "solve", source, "rest", "no answer within", HANG_SECONDS))
    for name, (source, reason) in RAISES.items():
        out.append(Misdeed(name, "import", source, "all", f"import: {reason}" if "xxx" not in reason else reason))
    for name, source in HARMLESS.items():
        out.append(Misdeed(name, "solve", source, "none"))
    for name, (source, reason) in PIPES.items():
        out.append(Misdeed(name, "solve", source, "rest", reason))
    out += [
        Misdeed("hang", "import", HANGS["hang"], "all", "no answer within", HANG_SECONDS),
        Misdeed("forks_twice", "import", HARMLESS["forks_twice"], "none"),
        Misdeed("changes_folder", "import", HARMLESS["changes_folder"], "none"),
        Misdeed(
            "patches_numpy", "import", "numpy.isfinite = numpy.diff = lambda *a: 1 / 0", "all", "ZeroDivisionError"
        ),
        Misdeed("patches_json", "import", PIPES["patches_json"][0], "all", "not an answer"),
        Misdeed("clears_modules", "import", "sys.modules.clear()", "all"),
        Misdeed("exit_0", "version", "os._exit(0)", "all", "exit status 0"),
        Misdeed("sys_exit", "version", "sys.exit(0)", "all", "version(): SystemExit: 0"),
        Misdeed("raises", "version", "raise OSError('no such\\nbinary')", "all", "version(): OSError: no such binary"),
        Misdeed("hang", "version", HANGS["hang"], "all", "no answer within", HANG_SECONDS),
        Misdeed("number", "version", "return 3", "all", "version: 3: Expected"),
        Misdeed("two_lines", "version", "return '1\\n::error 2'", "all", "version: '1\\n::error 2'"),
        Misdeed("surrogate", "version", "return '1\\ud800'", "all", "version: "),
        Misdeed("exit_0", "unsupported", "os._exit(0)", "all", "exit status 0"),
        Misdeed("sys_exit", "unsupported", "sys.exit(0)", "all", "unsupported(): SystemExit: 0"),
        Misdeed("raises", "unsupported", "raise OSError('no\\nserver')", "all", "unsupported(): OSError: no server"),
        Misdeed("hang", "unsupported", HANGS["hang"], "all", "no answer within", HANG_SECONDS),
        Misdeed("number", "unsupported", "return 5", "all", "unsupported(): 5: neither a reason nor None"),
        Misdeed("two_lines", "unsupported", "return 'no\\n::error'", "all", "no ::error"),
        Misdeed("surrogate", "unsupported", "return 'no \\ud800'", "all", "no ?"),
    ]
    return tuple(out)


TABLE = _table()
"""All that need a process of their own."""

DECLARATIONS = {
    "name = 'two\\nlines'": "name: ",
    "name = ''": "name: ''",
    "name = None": "name: None",
    "name = '../../x'": "name: '../../x'",
    "title = None": "title: None",
    "title = 'a\\nb'": "title: ",
    "effects = None": "effects: None",
    "effects = {'prestretch': 1}": "effects: ",
    "levels = ()": "levels: ()",
    "levels = 'many'": "levels: 'many'",
    "levels = (20, 10)": "not ascending",
    "levels = (0, 1)": "levels: ",
    "levels = (1.5, 3)": "levels: ",
    "levels = 10": "levels: 10",
    "order = -1": "order: -1",
    "order = float('nan')": "order: nan",
    "order = 'two'": "order: 'two'",
    "hint = 5": "hint: 5",
    "motions = ()": "motions: []",
    "motions = 'all'": "motions: 'all'",
    "digits = 0": "digits: 0",
    "digits = 'nine'": "digits: 'nine'",
    "independence = 'mine'": "independence",
    "version = None": "version(): TypeError",
    "order = property(lambda s: 1 / 0)": "ZeroDivisionError",
    "levels = property(lambda s: sys.exit(0))": "SystemExit",
}
"""A line of a class that declares something wrong, and what the reason must say."""

ANSWERS = {
    "return None": "NoneType, not Modes",
    "return {'frequencies': [1.0]}": "dict, not Modes",
    "raise CodeError('no steady\\nstate \\ud800')": "no steady state ?",
    "sys.exit(0)": "SystemExit: 0",
    "raise BaseException": "BaseException",
    "os.write(3, b'hello')": "OSError",
    "f = numpy.arange(1.0, 4); f[1] = numpy.nan; return made(frequencies=f)": "frequencies: [nan]: not finite",
    "return made(frequencies=numpy.array([1.0, 2.0, numpy.inf]))": "frequencies: [inf]: not finite",
    "return made(frequencies=numpy.array([1.0, 2.0, 1e300]))": "above 1e+100",
    "return made(frequencies=numpy.arange(1.0, 4) + 0j)": "frequencies: ",
    "return made(frequencies=numpy.array([-1.0, 2.0, 3.0]))": "negative",
    "return made(frequencies=numpy.array([3.0, 2.0, 1.0]))": "not ascending",
    "return made(frequencies=numpy.zeros(0), shapes=numpy.zeros((0, 21, 4), complex))": "frequencies: 0 returned, 3 requested",
    "return good(omega, elements, count + 1)": "frequencies: 4 returned, 3 requested",
    "return made(frequencies='high')": "frequencies: 'high'",
    "return made(frequencies=None)": "frequencies: None",
    "return made(frequencies=['1', '2', '3'])": "frequencies: ",
    "return made(shapes=numpy.ones((2, 21, 4), complex))": "shapes: 2 for 3 frequencies",
    "return made(shapes=numpy.ones((3, 20, 4), complex))": "shapes: each must be 21 stations by 4 columns",
    "return made(shapes=numpy.ones((3, 21, 3), complex))": "shapes: each must be 21 stations by 4 columns",
    "return made(shapes=numpy.ones((3, 21, 4)))": "shapes: ",
    "return made(shapes=numpy.full((3, 21, 4), numpy.nan + 0j))": "shapes: [nan]: not finite",
    "return made(shapes=numpy.ones((3, 21), complex))": "shapes: 2 dimensions instead of 3",
    "return made(shapes=[object()])": "its answer: TypeError",
    "return made(shapes={'sizes': [3, 21, 4], 'base64': '?'})": "shapes: not [3, 21, 4] complex numbers in base64",
    "return made(shapes={'sizes': [3, 21, 4], 'base64': 'AAAA'})": "shapes: not [3, 21, 4] complex numbers in base64",
    "return made(shapes={'sizes': [10**7] * 5, 'base64': ''})": "shapes: not [10000000, ",
    "return made(shapes={'sizes': [10**30], 'base64': ''})": "shapes: ",
    "return made(damping=numpy.zeros(2))": "damping: 2 values for 3 frequencies",
    "return made(damping=numpy.full(3, numpy.nan))": "damping: [nan]: not finite",
    "return made(damping=numpy.full(3, 2.0))": "damping: ",
    "return made(uncertainty=numpy.zeros(4))": "uncertainty: 4 values for 3 frequencies",
    "return made(uncertainty=-numpy.ones(3))": "uncertainty: [-1.0, -1.0, -1.0]: negative",
    "return made(rounding=numpy.full(3, numpy.inf))": "rounding: [inf]: not finite",
    "return made(elements='many')": "elements: 'many'",
    "return made(elements=0)": "elements: 0",
    "return made(elements=2.5)": "elements: 2.5",
    "return made(elements=10**4000)": "elements: ",
    "return made(omega=1.0)": "omega: 1.0: the requested speed is",
    "return made(omega='slow')": "omega: 'slow'",
    "return made(seconds='fast')": "seconds: 'fast'",
    "return made(seconds=float('nan'))": "seconds: nan",
    "return made(seconds=-1.0)": "seconds: -1.0",
    "return made(strain='none')": "strain: 'none'",
    "return made(strain=float('inf'))": "strain: inf",
}
"""Answers of one code, one after another in one process, and what the reason must say; each costs itself and no other."""


def module(folder: Path, name: str, lines: str) -> str:
    """A module in a folder, with the template's imports; its name."""
    (folder / f"{name}.py").write_text(TEMPLATE.partition("{at_import}")[0] + lines, encoding="utf-8")
    return name


def declaring(folder: Path) -> dict[str, str]:
    """Import path of each code of ``DECLARATIONS``, by its line."""
    lines, paths = "", {}
    for number, line in enumerate(DECLARATIONS):
        head = f"class C{number}(Base):\n    version = unsupported = lambda self, blade=None: None\n    modes = good\n"
        lines += f"{head}    {line}\nCODE{number} = C{number}()\n"
        paths[line] = f"misdeclared:CODE{number}"
    module(folder, "misdeclared", lines)
    return paths


def answering(folder: Path) -> str:
    """Import path of a code that gives answer k of ``ANSWERS`` at 10 + k rad/s, and a good one at any other speed."""
    lines = "class Code(Base):\n    version = lambda self: '1'\n    unsupported = lambda self, blade: None\n"
    lines += "    def modes(self, blade, omega, elements, count):\n        def made(**change):\n"
    lines += "            modes = good(omega, elements, count)\n"
    lines += "            [object.__setattr__(modes, *item) for item in change.items()]\n            return modes\n"
    for number, line in enumerate(ANSWERS):
        lines += f"        if omega == {10.0 + number}:\n            {line}\n"
    return (
        module(folder, "misanswering", lines + "        return good(omega, elements, count)\nCODE = Code()\n") + ":CODE"
    )
