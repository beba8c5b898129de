#!/usr/bin/python3
"""One run: mesh, solve, ledger; and how safe it is. It goes on where an earlier call was stopped, and does nothing if an earlier call
reached an end.

    run.py PROGRAMS STEM TOLERANCE [STATES [OPTION...]]

STEM.inputs lists the inputs of the run (inputs.py). Makes STEM.case.h5, STEM.results/, STEM.ledger.csv, STEM.log, and STEM.status when the
run ends by itself: a word, then the messages. `done`: to the end, and every kilogram is accounted for; `refused`: the input is wrong;
`failed`: the computation could not go on; `unbalanced`: a residual of the ledger is above TOLERANCE. Then the exit code is 0, whatever the
word. Otherwise it is that of the program that was stopped or could not use a file, and the next call goes on.

STATES says of which states the factor of safety is wanted: start, last, all, or checks for none; OPTIONs are those of the strength reduction.
With STATES `case` it is that of the start, and nothing is made but the case.
Then there are also STEM.check.csv and STEM.factors.csv, where there is something to write, and STEM.assessed at the end: lines `check: MESSAGE`
and `factor: MESSAGE`, why there is no such number, and `warning: MESSAGE`.

PROGRESS=1 is for a scene of one's own: it shows the messages of the programs instead of keeping them in STEM.log. There is a status then only
if the run is done; the exit code is 2 if it was refused, and 3 if it failed or is unbalanced.
"""

import fcntl
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

workflows = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(1, str(workflows))
from assessment import is_assessed
from common import read, set_options, write

programs, stem, tolerance, *safety = sys.argv[1:]
programs, stem, alone = pathlib.Path(programs).absolute(), pathlib.Path(stem), bool(os.environ.get("PROGRESS"))
os.chdir(stem.parent)
name = stem.name
inputs, status, case, results, ledger, check, factors, assessed = (pathlib.Path(f"{name}.{end}") for end in (
    "inputs", "status", "case.h5", "results", "ledger.csv", "check.csv", "factors.csv", "assessed"))
# The inputs of the case, and what the last program said.
started, messages = pathlib.Path(f".{name}.started"), pathlib.Path(f".{name}.messages")


def call(program, *arguments, **streams):
    """Runs a program, which inherits the lock. Its exit code, after which this script goes on, and what it said where that is caught."""
    ended = subprocess.run([programs / program, *arguments], close_fds=False, **streams)
    code = ended.returncode if ended.returncode >= 0 else 128 - ended.returncode
    if code not in (0, 2, 3):
        said = f"stopped with exit code {code} of {pathlib.Path(program).name}"
        with messages.open("a", encoding="utf-8") as file:
            print(said, file=file)
        print(name, said)
        sys.exit(code)
    return code, ended.stderr


def steps():
    """Program, the word for its exit code 3, arguments."""
    text = read(inputs)
    if not (case.exists() and started.exists() and read(started) == text):
        lines = [line.partition(" ") for line in text.splitlines()]
        (scene,), changes = ([rest for word, _, rest in lines if word == wanted] for wanted in ("scene", "set"))
        started.unlink(missing_ok=True)  # until the case is whole, an earlier one fits no inputs
        again = [rest for word, _, rest in lines if word == "adapt"]
        if again:
            yield workflows / "adapt.py", "failed", *["--by-default"] * bool(again[0]), programs, scene, name, *set_options(changes)
        else:
            yield "suffuse-mesher", "refused", scene, *set_options(changes), "-o", case
        shutil.rmtree(results, ignore_errors=True)
        ledger.unlink(missing_ok=True)
        write(started, text)
    if safety[:1] == ["case"]:
        return
    yield "suffuse-solver", "failed", case, "-o", results, *["--quiet"] * (not alone), *["--resume"] * results.exists()
    yield "suffuse-post", "unbalanced", "ledger", results, "--csv", ledger, "--tolerance", tolerance


def run(log):
    """The word of the status."""
    for program, word, *arguments in steps():
        if alone:
            code, _ = call(program, *arguments)
        else:
            with messages.open("w", encoding="utf-8") as said:
                code, _ = call(program, *arguments, stdout=log, stderr=said)
            log.write(read(messages))
            log.flush()
        if code:
            return "refused" if code == 2 else word
    return "done"


def make():
    write(messages, "")
    word = run(None if alone else open(f"{name}.log", "w", encoding="utf-8"))
    if alone and word != "done":
        status.unlink(missing_ok=True)
        sys.exit(2 if word == "refused" else 3)
    write(status, f"{word}\n{read(messages)}")
    print(name, word)


def assess(states, *options):
    # A table of an earlier state must not stay where the new state has none.
    for earlier in (check, factors, assessed):
        earlier.unlink(missing_ok=True)
    has_state, found = (results / "run.json").exists(), ""  # a run that failed at its start has no state
    asked = [("check", "suffuse-post", "check", results, "--csv", check)] if has_state else []
    if states != "checks" and not read(status).startswith("refused") and (has_state or states in ("start", "case")):
        state = {"last": ["--state", results], "all": ["--state", results, "--time", "all"]}.get(states, [])
        asked.append(("factor", "suffuse-solver", case, "--strength-reduction", *state, *options, "--quiet", "-o", factors))
    for what, program, *arguments in asked:  # the first error of each program, and its warnings
        code, said = call(program, *arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        warnings = [line for line in said.splitlines() if ": warning: " in line]
        found += "".join(re.sub("^.*: warning: ", "warning: ", line) + "\n" for line in warnings)
        if code:
            found += f"{what}: {next((line for line in said.splitlines() if line and line not in warnings), '')}\n"
    write(assessed, found)


# A program goes on when make above it is killed. Programs inherit the lock, so this waits for them.
lock = os.open(f".{name}.lock", os.O_RDWR | os.O_CREAT, 0o666)
os.set_inheritable(lock, True)
fcntl.flock(lock, fcntl.LOCK_EX)
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):  # the solver still writes its checkpoint
    signal.signal(number, lambda *_: None)
if not status.exists() or status.stat().st_mtime_ns <= inputs.stat().st_mtime_ns:
    make()
if safety and not is_assessed(pathlib.Path(".."), name):
    assess(*safety)
