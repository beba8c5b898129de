"""What the studies of levels have in common: the boundaries whose head is raised, the keys of a run at a level, and what the
runs say.

A constant head is replaced by the level. A head that changes in time is stretched from its first value, so that its highest
value is the level: h(t) becomes h(0) + (h(t) - h(0)) (level - h(0)) / (max h - h(0)).
"""

import json
import os
import pathlib
import re
import sys
import tomllib

workflows = pathlib.Path(__file__).resolve().parent.parent
sys.path[1:1] = [str(workflows), str(workflows / "sweep")]
from assessment import (SLOPE, STATES, WITHOUT_STRENGTH, creep_of, is_assessed, may_have_strength, messages_of, outcomes_of, reduction_options,
                        said_of_options, said_of_others, table_in, with_absent)
from common import (InputError, csv_text, end_with, find_file, folder_of, is_number, number_of, read, read_csv, read_rows, read_scene,
                    write_changed, wrong)
from sweep import make, read_status, refuse_foreign

# Laws of soil that fails, with the keys of elastic soil.
WITH_MODULI = ("mohr-coulomb", "von-mises")
NAME = re.compile(r"[\w-]+")  # of a soil, as a key of TOML without quotes
STEADY_END = 1.0  # s: by then hardly any fines have left
# A number in a warning; not that of a name or an index, such as soil2 or boundary[0].
NUMBER = re.compile(r"(?<![\w.\[])[-+]?\d+(\.\d+)?([eE][-+]?\d+)?(?![\w\]])")


def number_in(variable, default=None):
    """The number of a variable of make."""
    text = os.environ.get(variable, "").strip()
    if not text and default is not None:
        return default
    value = number_of(text)
    if value is None:
        raise wrong(variable, "", f"'{text}'" if text else "nothing", "a number")
    return value


def changes_in(variable):
    """KEY=VALUE pairs with spaces between them; spaces in quotes and brackets are part of a value."""
    changes, depth, quote = [""], 0, ""
    for sign in os.environ.get(variable, ""):
        if quote:
            quote = "" if sign == quote else quote
        elif sign in "\"'":
            quote = sign
        depth += (sign in "[{") - (sign in "]}") if not quote else 0
        if sign.isspace() and not quote and not depth:
            changes.append("")
        else:
            changes[-1] += sign
    changes = [change for change in changes if change]
    for change in changes:
        if "=" not in change:
            raise wrong(variable, "", f"'{change}'", "KEY=VALUE, with spaces between several")
    return dict(change.split("=", 1) for change in changes)


def toml(value):
    """A value of a scene as a text of one line. Tables apart, what JSON writes is TOML, except inf."""
    return repr(value) if isinstance(value, float) else json.dumps(value, ensure_ascii=False, default=str)


def pairs_of_file(path):
    """The table of a head in a file with the columns t and head."""
    try:
        names, *rows = [[cell.strip() for cell in row] for row in read_csv(path) if row]
        return [[float(dict(zip(names, row))[name]) for name in ("t", "head")] for row in rows]
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise InputError([f"{path}: is no table with the columns t (s) and head (m): {error}"]) from None


def names_in(text, known):
    """The names in a text, with blanks between them; a name that is known may have blanks, too."""
    words, names = text.split(), {}
    while words:
        count = next((count for count in range(len(words), 0, -1) if " ".join(words[:count]) in known), 1)
        names[" ".join(words[:count])] = None
        words = words[count:]
    return list(names)


def is_head(key, place):
    """Whether a key of SET changes the head of a boundary."""
    return key == f"boundary[{place}]" or key.startswith((f"boundary[{place}].head", f"boundary[{place}].file"))


class Other:
    """A boundary with a head. `key`: the key of the scene with which runs change it. `file`: that of its table, or None. `head`: a
    number, or what its table is."""

    def __init__(self, path, place, entry):
        self.name, self.key, self.entry = str(entry.get("on")), f"boundary[{place}].head", entry
        self.file, self.head = None, entry.get("head")
        if "file" in entry:
            self.key = f"boundary[{place}]"
            self.file = (path.parent / str(entry["file"])).resolve()
            self.head = self._table()

    def _table(self):
        try:
            return pairs_of_file(self.file)
        except InputError:  # the mesher says what is wrong
            return None


class Raised(Other):
    """A boundary that gets the level. `history`: the table of its head, or None."""

    def __init__(self, path, place, entry):
        super().__init__(path, place, entry)
        self.history = None if is_number(self.head) else self.head
        if self.history is None:
            return
        if not (isinstance(self.head, list) and self.head and all(isinstance(pair, list) and len(pair) == 2 and
                                                                   all(map(is_number, pair)) for pair in self.head)):
            raise wrong(path, f"boundary[{place}].head", toml(self.head), "a number, or pairs [[t, head], ...]")

    def _table(self):
        return pairs_of_file(self.file)

    def check_levels(self, variable, levels):
        """Throws InputError where the hydrograph cannot be stretched to a level."""
        if self.history is None:
            return
        first, highest = self.history[0][1], max(head for _, head in self.history)
        if not highest > first:
            raise wrong("BOUNDARY", "", f"a table of heads that never rises above its first, {first:g} m",
                        "one that rises, or STEADY=1")
        if min(levels) < first:
            raise wrong(variable, "", f"{min(levels):g}", f"a level above {first:g} m, the first head of the table")

    def cell(self, level):
        """The value of the boundary's key at a level."""
        head = level
        if self.history is not None:
            first, highest = self.history[0][1], max(head for _, head in self.history)
            scale = (level - first) / (highest - first)
            head = [[t, float(f"{first + scale * (value - first):.10g}")] for t, value in self.history]
        if not self.key.endswith("]"):
            return toml(head)
        entry = {key: value for key, value in self.entry.items() if key != "file"} | {"head": head}
        return "{" + ", ".join(f"{key} = {toml(value)}" for key, value in entry.items()) + "}"

    def level_of(self, cell):
        """The level of a value of the boundary's key, or None."""
        try:
            head = tomllib.loads(f"x = {cell}")["x"]
            head = head["head"] if isinstance(head, dict) else head
            return rounded(max(pair[1] for pair in head) if isinstance(head, list) else head)
        except (ValueError, KeyError, TypeError, IndexError):
            return None


class Study:
    """The scene, and the changes of it that its runs have in common."""

    def __init__(self, path):
        self.path = path
        self.scene = read_scene(path)
        self.own = changes_in("SET")
        self.raised = []
        self._find_boundaries()
        steady = os.environ.get("STEADY", "").strip()
        if steady not in ("", "0", "1"):
            raise wrong("STEADY", "", f"'{steady}'", "1, or nothing")
        if steady == "1":
            for raised in self.raised:
                raised.history = None
        self._refuse_parts()
        self.is_steady = self.raised[0].history is None
        self.keys = [raised.key for raised in self.raised]
        self.states = os.environ.get("FACTOR", "").strip() or ("start" if self.is_steady else "all")
        self.states = {"0": "checks", "1": "last"}.get(self.states, self.states)
        if self.states not in STATES:
            raise wrong("FACTOR", "", f"'{self.states}'", "start, last, all, or checks")

    def _find_boundaries(self):
        entries = self.scene.get("boundary", [])
        entries = [entry if isinstance(entry, dict) else {} for entry in entries if isinstance(entries, list)]
        with_head = [str(entry.get("on")) for entry in entries if {"head", "file"} & entry.keys()]
        known = " or ".join(f'"{on}"' for on in with_head) or "a scene with such a boundary; this one has none"
        names = names_in(os.environ.get("BOUNDARY", ""), [entry.get("on") for entry in entries])
        for name in names or [""]:
            place = next((place for place, entry in enumerate(entries) if entry.get("on") == name), None)
            if place is None:
                found = f'"{name}", which is no boundary of {self.path}' if name else "nothing"
                raise wrong("BOUNDARY", "", found, f"a boundary with a head: {known}")
            if name not in with_head:
                raise wrong("BOUNDARY", "", f'"{name}", which has no head', f"a boundary with a head: {known}")
            taken = [key for key in self.own if is_head(key, place)]
            if taken:
                raise wrong("SET", taken[0], "the head that this study varies", "other keys")
            self.raised.append(Raised(self.path, place, entries[place]))
        others = [(place, entry) for place, entry in enumerate(entries) if str(entry.get("on")) in with_head and str(entry.get("on")) not in names]
        self.others = [Other(self.path, place, entry) for place, entry in others if not any(is_head(key, place) for key in self.own)]

    def _refuse_parts(self):
        """Throws InputError where a boundary that is not raised has the table of one that is: the same water would have two levels."""
        first = self.raised[0]
        for raised in self.raised[1:]:
            if (raised.history is None) != (first.history is None):
                raise wrong("BOUNDARY", "", f'"{first.name}" and "{raised.name}", of which one has a table of heads and one a number',
                            "boundaries of one kind, or STEADY=1")
        for raised in self.raised:
            for other in self.others:
                if not is_number(raised.head) and (other.file == raised.file is not None or other.head == raised.head):
                    what = "file" if other.file == raised.file is not None else "table of heads"
                    raise wrong("BOUNDARY", "", f'"{raised.name}" without "{other.name}", which has the same {what} and would keep its level',
                                f'BOUNDARY="{self._names(other)}", or another {other.key} in SET')

    def _names(self, *others):
        return " ".join(boundary.name for boundary in (*self.raised, *others))

    def said_of_equal(self):
        """Sentences about boundaries whose head is the same number, and which keep it: those of the same water must rise, too."""
        said = []
        for other in self.others:
            equal = next((raised for raised in self.raised if is_number(other.head) and other.head == raised.head), None)
            if equal:
                said.append(f'"{other.name}" has the head of "{equal.name}" in the scene, {other.head:g} m, and keeps it at all levels; '
                            f'if it borders the same water, the result is not safe: give BOUNDARY="{self._names(other)}"')
        return said

    def check_levels(self, variable, levels):
        """Throws InputError where a hydrograph cannot be stretched to a level."""
        for raised in self.raised:
            raised.check_levels(variable, levels)

    def cells(self, level):
        """The values of the keys at a level."""
        return [raised.cell(level) for raised in self.raised]

    def level_of(self, row):
        """The level of a row of a table, or None if it has none, or several."""
        level = self.raised[0].level_of(row.get(self.keys[0]))
        return level if level is not None and self.cells(level) == [row.get(key) for key in self.keys] else None

    def changes(self):
        """The changes that all runs have in common."""
        steady = {}
        if self.is_steady and "from" not in self.scene.get("initial", {}):
            end = float(self.own.get("time.end", min(STEADY_END, self.scene.get("time", {}).get("end", STEADY_END))))
            steady = {"initial.flow": '"steady"', "time.end": f"{end:g}", "output.every": f"{end:g}", "output.snapshot_every": f"{end:g}"}
        return steady | self.own

    def elastic_changes(self):
        """The changes of runs whose soil does not fail, for a slope that is looked at apart: at the start of a steady level, where
        runs are wanted for their flow alone. None where the slope cannot be looked at apart, or where no soil has a strength."""
        if not self.is_steady or self.states != "start" or "from" in table_in(self.scene, "initial"):
            return None
        skeletons = {}
        for name in table_in(self.scene, "soil"):
            found = self._skeleton_of(name)
            if found is None:
                return None
            if found.get("law", "rigid") not in WITHOUT_STRENGTH:
                if found["law"] not in WITH_MODULI or not {"young", "poisson"} <= found.keys():
                    return None
                skeletons[f"soil.{name}.skeleton"] = {"law": "elastic", "young": found["young"], "poisson": found["poisson"]}
        if not skeletons:
            return None
        kept = {key: value for key, value in self.changes().items() if ".".join(key.split(".")[:3]) not in skeletons}
        return kept | {key: "{" + ", ".join(f"{name} = {toml(value)}" for name, value in table.items()) + "}" for key, table in skeletons.items()}

    def may_slide(self):
        """Whether a soil of the runs may have a strength; runs beside which the slope is looked at have elastic soil."""
        soils = table_in(self.scene, "soil")
        return self.elastic_changes() is None and any(may_have_strength(soils, name, list(self.own)) for name in soils)

    def _skeleton_of(self, name, known=()):
        """The keys of the skeleton of a soil, with those of the soil that it is like and those of SET; None where that is not clear."""
        soil = table_in(table_in(self.scene, "soil"), name)
        whole = [key for key in self.own if key in ("soil", f"soil.{name}", f"soil.{name}.like") or f"soil.{name}" in key and '"' in key]
        if whole or name in known or not NAME.fullmatch(name):
            return None
        like = soil.get("like")
        keys = self._skeleton_of(like, (*known, name)) if isinstance(like, str) else {}
        if keys is None:
            return None
        keys = keys | table_in(soil, "skeleton")
        for key, value in self.own.items():
            try:
                if key == f"soil.{name}.skeleton":
                    keys = table_in(tomllib.loads(f"x = {value}"), "x")
                elif key.startswith(f"soil.{name}.skeleton."):
                    keys = keys | {key.split(".", 3)[3]: tomllib.loads(f"x = {value}")["x"]}
            except tomllib.TOMLDecodeError:
                return None
        return keys


def rounded(level):
    return float(f"{level:.10g}")


def write_table(study, folder, rows, slopes=None):
    """The table of the sweep, and that of a slope that is looked at apart. Throws InputError if the folder is that of another scene,
    or for wrong options of the slope."""
    reduction_options(study.scene, rows[0] if slopes is None else slopes[0], study.states)
    refuse_foreign(folder / "runs", study.path, folder.resolve() / "table.csv")
    write_changed(folder / "table.csv", csv_text(rows))
    if slopes is None:
        (folder / "slope.csv").unlink(missing_ok=True)
    else:
        write_changed(folder / "slope.csv", csv_text(slopes))


def rows_of_sweep(folder):
    """The rows of the sweep as far as it was made, as dictionaries."""
    return read_rows(folder / "runs" / "sweep.csv")


def outcomes(study, folder, rows, slopes=None):
    """What the mechanisms did in each run. `rows`: key -> row of the sweep. `slopes`: key -> run of a slope that is looked at apart."""
    found = with_absent({key: outcomes_of(folder / "runs", row["run"], row["status"], row["message"], study.states)
                         for key, row in rows.items()})
    if slopes is None:
        return found
    apart = {key: outcomes_of(folder / "slope", row["run"], row["status"], row["message"], study.states)[0] for key, row in slopes.items()}
    without = {key: {name: outcome for name, outcome in run.items() if name != SLOPE} for key, run in found.items()}
    return {key: run | apart.get(key, {}) for key, run in without.items()}


def slopes_of(study, folder):
    """Level -> run in the folder slope/, with its status and message, of those that have ended. None if the slope is not looked at apart."""
    if study.elastic_changes() is None:
        return None
    changes, slopes = study.changes(), {}
    for row in read_rows(folder / "slope" / "runs.csv"):
        level = study.level_of(row)
        if level is not None and changes.items() <= row.items() and is_assessed(folder / "slope", row["run"]):
            status, message = read_status(folder / "slope", row["run"])
            if status != "unfinished":
                slopes[level] = {"run": row["run"], "status": status, "message": message}
    return slopes


def said_beside(study, folder, rows, mechanisms, start):
    """Sentences about what the study leaves out: checks that do not depend on the level, soil, and what is not checked where
    soil moves. `start`: of the first."""
    names = [row["run"] for row in rows]
    others = said_of_others(folder / "runs" / name / name for name in names)
    header = read_csv(folder / "table.csv")[0]
    options = said_of_options(reduction_options(study.scene, header, study.states))
    moves = SLOPE in mechanisms and not {"hyd-stresses", "hyd-forces", "uplift"} & set(mechanisms)
    return ([f"{start}, as they do not depend on the level: {others}."] * bool(others) + [f"Of the slope, {options}."] * bool(options)
            + ["Heave by EN 1997-1 and uplift are not checked where soil moves: a study without strengths looks at them."] * moves)


def creep_of_runs(study, folder, rows, found):
    """Key -> by how much soil moved, m, of the runs where that is much and the slope does not fail. `rows`: key -> row of the sweep.
    `found`: key -> outcomes."""
    held = [key for key in rows if study.may_slide() and not (SLOPE in found[key] and found[key][SLOPE].fails)]
    moved = {key: creep_of(folder / "runs" / rows[key]["run"] / rows[key]["run"]) for key in held}
    return {key: length for key, length in moved.items() if length > 0.0}


def warnings_of(stem):
    """The warnings of the programs in a run, each once, without a change that stands before its key."""
    found = {}
    for suffix in ("log", "assessed"):
        path = stem.with_name(f"{stem.name}.{suffix}")
        lines = read(path).splitlines() if path.is_file() else []
        for text in (line.partition("warning: ")[2] for line in lines if re.match(r"([\w-]+: )?warning: ", line)):
            found[re.sub(r"^--set ([^=\s]+)=.*: (?=\1)", "", text)] = None
    return list(found)


def stems_of(folder, row):
    """The run of a row, and that of its slope if it is looked at apart."""
    return [folder / name / run / run for name, run in (("runs", row["run"]), ("slope", row.get("slope"))) if run]


def named_warnings(folder, rows):
    """A line for each warning of the runs. Warnings that differ in their numbers only are one."""
    kinds = {}
    for row in rows:
        texts = {NUMBER.sub("#", text): text for stem in stems_of(folder, row) for text in warnings_of(stem)}
        for kind, text in texts.items():
            kinds.setdefault(kind, []).append((row["run"], text))
    lines = []
    for found in kinds.values():
        run, text = found[0]
        differ = any(other != text for _, other in found)
        lines.append(f"warning: {text} ({len(found)} of {len(rows)} runs{f'; these are the numbers of {run}' if differ else ''})")
    return lines


def report(study, folder, lines, rows, silent):
    """Writes and prints the report, and what the programs said. Returns the exit code."""
    warnings = study.said_of_equal()
    lines = [*(f"Warning: {text}." for text in warnings), *[""] * bool(warnings), *lines]
    write_changed(folder / "report.md", "\n".join(lines) + "\n")
    print("\n".join([*lines, f"Tables and chart are in {folder.resolve()}"]), flush=True)
    for line in [f"warning: BOUNDARY: {text}" for text in warnings] + named_warnings(folder, rows) + named_failures(folder, silent):
        print(f"{pathlib.Path(sys.argv[0]).name}: {line}", file=sys.stderr)
    return 1 if silent else 0


def why_silent(folder, row):
    """Why a run that has ended without a message has no answer."""
    if row["status"] != "done" or not is_assessed(folder / "runs", row["run"]):
        return "has no answer; call make again"
    stem = folder.resolve() / "runs" / row["run"] / row["run"]
    said = messages_of(stem)
    return "no mechanism acts in this run: " + "; ".join((
        said.get("check", f"no check has a factor, and suffuse-post check {stem}.results says why"), said.get("factor", "the slope was not looked at")))


def named_failures(folder, rows):
    """A line for each run that has no answer, ten at most."""
    lines = [f"{row['run']} {row['status']}: {row['message'] or why_silent(folder, row)}" for row in rows]
    return lines[:10] + ([f"... and {len(lines) - 10} more: see runs/sweep.csv"] if len(lines) > 10 else [])


def call(target, prepare, conclude):
    """The study OUT/TARGET/NAME. Its runs are one sweep, whose table grows round by round: which levels follow depends on the runs
    before. A slope that is looked at apart has a sweep of its own, with the table slope.csv and the folder slope/."""
    def work():
        study = Study(find_file("SCENE"))
        if target == "fragility":
            os.environ["SWEEP"] = str(find_file("SWEEP"))
        folder, made = folder_of(target, study.path), None
        table, slope = (folder.resolve() / f"{name}.csv" for name in ("table", "slope"))
        prepare(study, folder)
        while (wanted := (read_csv(table), read_rows(slope))) != made:
            made = wanted
            # Soil that fails in a run is an answer, not the end of the study.
            if slope.is_file():
                make(study.path, table, folder / "runs", "checks", with_reduction=False)
                make(study.path, slope, folder / "slope", "case")
            else:
                make(study.path, table, folder / "runs", study.states)
            prepare(study, folder)
        return conclude(study, folder)

    end_with(f"{target.replace('-', '_')}.py: ", work)
