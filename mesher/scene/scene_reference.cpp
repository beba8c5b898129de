#include <array>
#include <sstream>

#include "scene/scene.hpp"
#include "scene/scene_schema.hpp"

namespace suffuse {
namespace {

constexpr const char* introduction = R"(# Scene reference

<!-- Generated from mesher/scene/scene_keys.cpp. To change it, change that and run
     suffuse-mesher --scene-reference > docs/reference/scene-reference.md -->

A scene is a [TOML](https://toml.io) file that `suffuse-mesher` turns into a case. Units are SI. Where
a number is expected, `6000`, `6e3` and `6000.0` are the same; `nan` is refused, and so is `inf`
except for `liquid.bulk_modulus`.

Every key of the file is checked before anything is computed. Unknown keys, wrong types, values out of
bounds, missing keys and keys that contradict each other are all reported at once, as
`FILE:LINE: KEY: got VALUE; expected WHAT; did you mean NAME?`, with exit code 2.

## Changing keys from the command line

`--set KEY=VALUE` gives a key of the scene another value, or adds it, as often as needed. It goes
through the same checks. Write keys in full, entries of `[[boundary]]` by position from 0:

    suffuse-mesher scene.toml --set soil.specimen.erosion.rate=5e-3 --set time.stepping=monotone
    suffuse-mesher scene.toml --set boundary[0].pressure=3e3
    suffuse-mesher scene.toml --set 'boundary[0].pressure=[[0, 0], [5, 6e3]]'
    suffuse-mesher scene.toml --set 'boundary[0]={on = "top", darcy_flux = 0.012}'

The value is TOML; a text that is not TOML, such as `monotone`, needs no quotes. Setting a whole table
replaces it, as in the last line: the pressure given in the file is gone.

## Keys

`-` stands for a quantity without a unit, or for a key without a symbol. Symbols are those of
[the theory](../theory/README.md).
)";

constexpr const char* example = R"(
## An example

Two layers under a pressure that rises to 6 kPa within 10 s; the lower does not erode. The regions
`sand` and `base` and the boundaries `top` and `bottom` are physical groups of `layers.geo`.

```toml
name        = "two-layers"
formulation = "single-point"

[geometry]
file = "layers.geo"

[mesh]
size = 0.05

[liquid]
density      = 1000.0
bulk_modulus = 2.0e7
viscosity    = 1.0e-3

[soil.sand]
porosity          = 0.3
skeleton_fraction = 0.6
grain_density     = 2700.0
conductivity      = 2.0e-2

[soil.sand.erosion]
law   = "constant"
rate  = 1.0e-3
start = 2.0

[soil.base]
like         = "sand"      # every key that is not given here
erosion.law  = "none"

[[boundary]]
on            = "top"
pressure      = [[0.0, 0.0], [10.0, 6.0e3]]
concentration = 0.0

[[boundary]]
on       = "bottom"
pressure = 0.0

[time]
end = 120.0

[output]
every = 1.0
```
)";

/// A part of a scene that shows the use of some keys.
struct Example {
  const char* title;
  const char* sentence;
  const char* text;
};

/// Each completes a scene with gravity, in which the soil is called `body`; scene_test reads them.
constexpr std::array examples{
    Example{
        "Reservoir and tailwater",
        "Hydrostatic pressure below each water level, however the boundary slopes; a seepage face "
        "above it. At the start the flow is steady.",
        R"([[boundary]]
on   = "upstream"
head = [[0.0, 2.0], [86400.0, 5.0]]   # rises within a day

[[boundary]]
on   = "tailwater"
head = 0.5

[initial]
flow = "steady"
)"},
    Example{
        "A flood from a table",
        "`flood.csv` lies beside the scene and begins with the line `t,head`. Above the river the "
        "bank is paved.",
        R"([[boundary]]
on   = "bank"
file = "flood.csv"
dry  = "impervious"

[initial]
water_level = 1.2
)"},
    Example{
        "Landside slope",
        "Water comes out where the soil is full and its pressure is that of the air. None enters.",
        R"([[boundary]]
on           = "landside"
seepage_face = true

[initial]
water_level = 0.0
)"},
    Example{
        "Rain on unsaturated soil",
        "The soil takes in what it can at p = 0; the rest runs off. At the start there is suction "
        "above the water table.",
        R"([[boundary]]
on   = "crest"
rain = [[0.0, 0.0], [3600.0, 5e-6]]

[soil.body.retention]
model               = "van-genuchten"
alpha               = 2.0
n                   = 1.6
residual_saturation = 0.1

[initial]
water_level = -1.0
)"},
    Example{
        "Laboratory column",
        "A pressure above, and below what a pump draws out: one of `velocity` and `darcy_flux`.",
        R"([[boundary]]
on            = "top"
pressure      = 6.0e3
concentration = 0.0

[[boundary]]
on         = "bottom"
darcy_flux = -1e-4

[initial]
water_level = 1.0
)"},
    Example{
        "Sheet pile and slurry wall",
        "`pile` and `slurry` are physical curves inside the mesh, embedded in a surface (`Curve{6} "
        "In Surface{1};`) or between two. The slurry wall is 0.6 m thick, of 1e-9 m/s.",
        R"([[wall]]
on = "pile"

[[wall]]
on          = "slurry"
conductance = 1.7e-9      # 1e-9 m/s / 0.6 m

[initial]
water_level = 0.0
)"},
    Example{
        "Wells and drains",
        "`pump` is a physical point inside the mesh (`Point{7} In Surface{1};`), the others are "
        "curves.",
        R"([[well]]
on   = "pump"
rate = [[0.0, 0.0], [60.0, -2e-5]]    # m3/s per m; negative: out of the soil

[[well]]
on   = "relief"
head = 1.5

[[well]]
on           = "pipe"
seepage_face = true       # a drain

[initial]
water_level = 2.0
)"},
    Example{"Bedding", "Ten times as conductive along layers that rise by 15 degrees to the right.",
            R"([soil.body]
conductivity = [1e-5, 1e-6]
bedding      = 15.0

[initial]
water_level = 0.0
)"},
    Example{
        "Excavation in stages",
        "`ground.results` are of a scene in which `pit` has the soil of the ground. Here the pit "
        "is dug within a day; a third scene may fill it again.",
        R"([soil.body.skeleton]
law      = "mohr-coulomb"
young    = 2.0e7
poisson  = 0.3
friction = 25.0
cohesion = 10.0e3

[soil.pit]
free = true

[initial]
from         = "ground.results"
construction = 86400.0
)"},
    Example{"What to record",
            "Pressure at a piezometer, and the discharge through a vertical line.",
            R"([[output.probe]]
at = [12.0, -1.5]

[[output.section]]
from = [10.0, -6.0]
to   = [10.0, 0.0]

[initial]
water_level = 0.0
)"}};

/// A cell of a Markdown table; `-` when there is nothing to say.
std::string cell(const std::string& text) {
  if (text.empty()) return "-";
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string code(const std::string& text) {
  return text.empty() ? text : '`' + text + '`';
}

std::string type_of(const SceneKey& key) {
  std::vector<std::string> all;
  switch (key.kind) {
    case ValueKind::text:
      return "text";
    case ValueKind::word:
      for (const std::string& word : key.words) all.push_back(code(shown_value(word)));
      return listed(all);
    case ValueKind::number:
      return key.infinite_allowed ? "number or `inf`" : "number";
    case ValueKind::number_or_pair:
      return "number, or pair `[along, across]`";
    case ValueKind::number_or_word:
      for (const std::string& word : key.words) all.push_back(code(shown_value(word)));
      return listed(all) + ", or number";
    case ValueKind::vector_function:
      return "array of 2 or 3 numbers, or `[[t, x, y], ...]`";
    case ValueKind::function:
      return "number, or pairs " + code("[[" + key.argument + ", value], ...]");
    case ValueKind::gradation:
      return "pairs `[[d, F], ...]`";
    case ValueKind::integer:
      for (const std::int64_t integer : key.integers) all.push_back(std::to_string(integer));
      return all.empty() ? "integer" : listed(all);
    case ValueKind::boolean:
      return "`true` or `false`";
    case ValueKind::vector:
      return "array of 2 or 3 numbers";
  }
  return {};
}

std::string default_of(const SceneKey& key) {
  if (!key.unless.empty()) return "required without " + code(key.unless);
  if (key.required) return "**required**";
  return key.default_value ? code(shown_value(*key.default_value)) : key.default_note;
}

void write_section(std::ostream& out, const SceneSection& section) {
  const bool is_table = section.heading.starts_with('[');
  out << "\n### " << (is_table ? code(section.heading) : section.heading) << "\n\n"
      << section.sentence << "\n\n"
      << "| key | symbol | type | unit | bounds | default | meaning |\n"
      << "|---|---|---|---|---|---|---|\n";
  for (const SceneKey& key : scene_keys()) {
    if (key.pattern != joined(section.pattern, key.leaf())) continue;
    for (const std::string& text : {code(key.leaf()), cell(key.symbol), cell(type_of(key)),
                                    cell(key.unit), cell(key.bounds()), cell(default_of(key))}) {
      out << "| " << text << ' ';
    }
    out << "| " << cell(key.sentence) << " |\n";
  }
}

}  // namespace

std::string scene_reference_markdown() {
  std::ostringstream out;
  out << introduction;
  for (const SceneSection& section : scene_sections()) write_section(out, section);
  out << example;
  out << "\n## Examples of seepage\n\nParts of scenes under gravity, as in `gravity = [0.0, "
         "-9.81]`.\n";
  for (const Example& part : examples) {
    out << "\n### " << part.title << "\n\n"
        << part.sentence << "\n\n```toml\n"
        << part.text << "```\n";
  }
  return out.str();
}

}  // namespace suffuse
