#!/usr/bin/python3
"""Steps and seconds of the implicit scheme, by run.json, and of the explicit one, by what --explain says: table.py STEM... > TABLE"""

import pathlib
import sys

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent))
from common import estimate_of, passes, run_json

print("conductivity_m_s,bulk_modulus_Pa,steps_implicit,flow_solved,seconds_implicit,steps_explicit,seconds_explicit_estimated")
for stem in sys.argv[1:]:
    conductivity, modulus = pathlib.Path(stem).name[1:].split("-K")
    run, explained = run_json(f"{stem}.results"), pathlib.Path(f"{stem}-explicit.explain")
    steps, seconds = "none", "none"
    if modulus != "inf":
        steps, seconds, *_ = estimate_of(explained.read_text(encoding="utf-8"))
        steps, seconds = steps or "none", f"{float(seconds):.2g}" if seconds else "none"
    print(conductivity, modulus, run["steps"], passes(run, "flow")[0]["calls"], f"{float(run['wall_seconds']):.2g}", steps, seconds, sep=",")
