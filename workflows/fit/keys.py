"""The keys that a calibration changes: where they start, in which variable they are searched, their unit.

    KEYS=soil.sand.erosion.rate,soil.sand.porosity:0.3:0.4      names, with bounds if wanted

The search moves x, which is 0 at the start: x = log(value / start) of a key whose start and bounds are above 0, so that
a rate may change by decades and stays positive; otherwise x = (value - start) / scale.
"""

import math
import re

from common import InputError, consult, is_number, number_of, problem, read_scene, set_options, wrong

SYNTAX = "KEY or KEY:LOW:HIGH with two numbers, LOW below HIGH, and commas between several"
# A part of a path like soil."my sand".erosion.rate or boundary[0].head.
PART = re.compile(r'"([^"]+)"|([^."\[\]]+)|\[(\d+)\]')
# Values are written with this many digits, and the search takes them as they are written.
DIGITS = 10


class Key:
    def __init__(self, name, start, low, high, unit):
        self.name, self.start, self.low, self.high, self.unit = name, start, low, high, unit
        self.logarithmic = start > 0.0 and (low == -math.inf or low > 0.0)
        if self.logarithmic:
            self.low = max(low, 0.0)
        self.scale = high - low if math.isfinite(high - low) else abs(start)

    def x_of(self, value):
        if self.logarithmic:
            return math.log(value / self.start) if value > 0.0 else -math.inf
        return (value - self.start) / self.scale

    def text_at(self, x):
        value = self.start * math.exp(x) if self.logarithmic else self.start + self.scale * x
        text = f"{min(max(value, self.low), self.high):.{DIGITS}g}"
        return text if re.search("[.e]", text) else f"{text}.0"

    def slope_at(self, value):
        """Change of the value per change of x."""
        return value if self.logarithmic else self.scale


def value_in(scene, path):
    """The value at a path of the scene, or None. A soil without it has that of the soil `like` it."""
    parts = [quoted or plain or int(index) for quoted, plain, index in PART.findall(path)]
    for _ in range(len(scene.get("soil", {})) + 1):
        found, soil = scene, None
        for depth, part in enumerate(parts):
            try:
                found = found[part]
            except (KeyError, IndexError, TypeError):
                found = None
                break
            if depth == 1 and parts[0] == "soil" and isinstance(found, dict):
                soil = found
        if found is not None or soil is None or "like" not in soil:
            return found
        parts[1] = soil["like"]
    return None


def split_keys(text):
    """Triples of name and bounds as they are written."""
    entries = [entry.strip() for entry in text.split(",") if entry.strip()]
    if not entries:
        raise wrong("KEYS", "", "nothing", SYNTAX)
    keys = []
    for entry in entries:
        name, *bounds = (part.strip() for part in entry.split(":"))
        ends = [number_of(bound) for bound in bounds] or [-math.inf, math.inf]
        if not name or len(ends) != 2 or None in ends or not ends[0] < ends[1]:
            raise wrong("KEYS", "", f"'{entry}'", SYNTAX)
        if name in (known for known, _, _ in keys):
            raise wrong("KEYS", "", f"'{name}' twice", "each key once")
        keys.append((name, *ends))
    return keys


def check_scene(programs, path, changes):
    """Throws InputError with what the mesher says of the scene with these changes. It makes no mesh."""
    consult(programs / "suffuse-mesher", path, *set_options(changes), "--check")


def refuse_unknown(programs, path, name):
    """Throws InputError with what the mesher says of a key that it does not know, whatever its value."""
    try:
        check_scene(programs, path, [f"{name}=0.5"])
    except InputError as error:
        if "unknown key" in str(error) or not str(error).startswith(f"--set {name}=0.5: {name}: "):
            raise


def units_of(scene, names, programs):
    """Units by the scene reference, which the mesher prints. That of a rate or a threshold goes with the drive."""
    said = consult(programs / "suffuse-mesher", "--scene-reference").stdout
    units, section = {}, ""
    for line in said.splitlines():
        if line.startswith("### "):
            section = line.strip("#` []")
        row = re.match(r"\| `(\w+)` \|", line)
        if row:
            units[section, row[1]] = re.split(r"(?<!\\)\|", line)[4].strip()
    found = {}
    for name in names:
        table, _, last = re.sub(r"\[\d+\]", "", name).rpartition(".")
        unit = units.get((re.sub(r'^soil\.("[^"]*"|[^.]*)', "soil.NAME", table), last), "")
        if '"' in unit:
            place = name.rpartition(".")[0]
            drive = "flux" if value_in(scene, f"{place}.law") == "flux" else value_in(scene, f"{place}.drive") or "time"
            of_drive = re.search(rf'"{drive}": ([^,()]+(?:\([^)]*\))?)', unit)
            unit = of_drive[1] if of_drive else re.match('[^"(]*', unit)[0].strip()
        found[name] = "" if unit in ("-", "1") else unit
    return found


def read_keys(text, path, programs):
    """The keys of KEYS. Throws InputError."""
    scene = read_scene(path)
    entries = split_keys(text)
    starts, problems = [], []
    for name, low, high in entries:
        value = value_in(scene, name)
        bounded = math.isfinite(low)
        if value is None and bounded:
            value = math.sqrt(low * high) if low > 0.0 else 0.5 * (low + high)
        starts.append(value)
        if value is None:
            refuse_unknown(programs, path, name)
            problems.append(problem(path, name, "no such key", f"a number, where the search starts, or bounds: KEYS={name}:LOW:HIGH"))
        elif not is_number(value):
            problems.append(problem(path, name, f"{value}", "a number: only numbers can be fitted"))
        elif not low <= value <= high:
            problems.append(problem("KEYS", name, f"the bounds {low:g} and {high:g}", f"bounds around {value:g}, the value of the scene"))
        elif value == 0.0 and not bounded:
            problems.append(problem(path, name, "0", f"another number, which tells how far the search may go, or bounds: KEYS={name}:LOW:HIGH"))
    if problems:
        raise InputError(problems)
    units = units_of(scene, [name for name, _, _ in entries], programs)
    keys = [Key(name, float(value), low, high, units[name]) for (name, low, high), value in zip(entries, starts)]
    check_scene(programs, path, [f"{key.name}={key.text_at(0.0)}" for key in keys])
    return keys, scene
