#include "case/scene_schema.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <type_traits>
#include <utility>

#include "case/law_texts.hpp"

namespace suffuse {
namespace {

// Where a key is kept.

template <class Member>
auto at(Member Scene::*member) {
  return [=](Scene& scene, std::size_t) -> Member& { return scene.*member; };
}

template <class Group, class Member>
auto at(Group Scene::*group, Member Group::*member) {
  return [=](Scene& scene, std::size_t) -> Member& { return scene.*group.*member; };
}

template <class Group, class Inner, class Member>
auto at(Group Scene::*group, Inner Group::*inner, Member Inner::*member) {
  return [=](Scene& scene, std::size_t) -> Member& { return scene.*group.*inner.*member; };
}

/// A number of rows of elements beside the specimen.
auto rows(int LayerSettings::*member) {
  return at(&Scene::geometry, &GeometrySettings::layers, member);
}

template <class Member>
auto in_soil(Member Soil::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.soils[i].*member; };
}

template <class Member>
auto in_erosion(Member ErosionSettings::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.soils[i].erosion.*member; };
}

template <class Member>
auto on_boundary(Member BoundaryCondition::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.boundaries[i].*member; };
}

// How a value is kept: one overload per type of member, and the kind of value it calls for.

void keep(double& member, const Value& value) {
  member = std::get<double>(value);
}
void keep(std::optional<double>& member, const Value& value) {
  member = std::get<double>(value);
}
void keep(std::optional<TimeFunction>& member, const Value& value) {
  if (const auto* constant = std::get_if<double>(&value)) {
    member = *constant;
    return;
  }
  std::vector<std::pair<double, double>> knots;
  for (const auto& row : std::get<Rows>(value)) knots.emplace_back(row[0], row[1]);
  member = TimeFunction(std::move(knots));
}
void keep(int& member, const Value& value) {
  member = static_cast<int>(std::get<std::int64_t>(value));
}
void keep(bool& member, const Value& value) {
  member = std::get<bool>(value);
}
void keep(std::optional<bool>& member, const Value& value) {
  member = std::get<bool>(value);
}
void keep(std::string& member, const Value& value) {
  member = std::get<std::string>(value);
}
void keep(std::array<double, 3>& member, const Value& value) {
  member = {};
  std::ranges::copy(std::get<std::vector<double>>(value), member.begin());
}

ValueKind kind_of(const double&) {
  return ValueKind::number;
}
ValueKind kind_of(const std::optional<double>&) {
  return ValueKind::number;
}
ValueKind kind_of(const std::optional<TimeFunction>&) {
  return ValueKind::time_function;
}
ValueKind kind_of(const int&) {
  return ValueKind::integer;
}
ValueKind kind_of(const bool&) {
  return ValueKind::boolean;
}
ValueKind kind_of(const std::optional<bool>&) {
  return ValueKind::boolean;
}
ValueKind kind_of(const std::string&) {
  return ValueKind::text;
}
ValueKind kind_of(const std::array<double, 3>&) {
  return ValueKind::vector;
}

template <class Access>
using MemberOf = std::remove_reference_t<std::invoke_result_t<Access, Scene&, std::size_t>>;

/// A key under construction; each call returns the key so that a declaration is one expression.
struct Declaration : SceneKey {
  Declaration&& named(std::string name) && { return set(symbol, std::move(name)); }
  Declaration&& in(std::string si_unit) && { return set(unit, std::move(si_unit)); }
  Declaration&& above(double x) && { return set(lower, Bound{x, true}); }
  Declaration&& at_least(double x) && { return set(lower, Bound{x, false}); }
  Declaration&& below(double x) && { return set(upper, Bound{x, true}); }
  Declaration&& at_most(double x) && { return set(upper, Bound{x, false}); }
  Declaration&& or_infinite() && { return set(infinite_allowed, true); }
  Declaration&& one_of(std::vector<std::int64_t> all) && { return set(integers, std::move(all)); }
  Declaration&& mandatory() && { return set(required, true); }
  Declaration&& otherwise(Value value) && { return set(default_value, std::move(value)); }
  Declaration&& otherwise_as(std::string note) && { return set(default_note, std::move(note)); }

 private:
  template <class Field, class New>
  Declaration&& set(Field& field, New&& value) {
    field = std::forward<New>(value);
    return std::move(*this);
  }
};

template <class Access>
Declaration key(const std::string& pattern, Access access, std::string sentence) {
  Declaration d;
  d.pattern = pattern;
  d.kind = kind_of(MemberOf<Access>{});
  d.sentence = std::move(sentence);
  d.store = [access](Scene& scene, std::size_t i, const Value& value) {
    keep(access(scene, i), value);
  };
  return d;
}

/// A key whose value is one of a few words, each standing for a value of the member.
template <class Access>
Declaration choice(const char* pattern, Access access,
                   const std::vector<std::pair<std::string, MemberOf<Access>>>& meanings,
                   std::string sentence) {
  Declaration d;
  d.pattern = pattern;
  d.kind = ValueKind::word;
  d.sentence = std::move(sentence);
  for (const auto& meaning : meanings) d.words.push_back(meaning.first);
  d.store = [access, meanings](Scene& scene, std::size_t i, const Value& value) {
    const auto& word = std::get<std::string>(value);
    access(scene, i) =
        std::ranges::find(meanings, word, [](const auto& m) { return m.first; })->second;
  };
  return d;
}

/// The laws that there are, as meanings of their words.
template <class Law>
std::vector<std::pair<std::string, const Law*>> by_word(std::span<const Law* const> laws) {
  std::vector<std::pair<std::string, const Law*>> meanings;
  for (const Law* law : laws) meanings.emplace_back(law->word, law);
  return meanings;
}

std::string no_erosion_word() {
  return shown_value(std::string(no_erosion()->word));
}

/// A number that only some erosion laws ask for.
Declaration erosion_parameter(const ErosionParameter& parameter) {
  const auto access = [value = parameter.value](Scene& scene, std::size_t i) -> double& {
    return scene.soils[i].erosion.parameters.*value;
  };
  const std::string laws = listed(laws_with_parameter(parameter.key));
  return key("soil.*.erosion." + std::string(parameter.key), access,
             std::string(parameter.sentence) + " With the law " + laws + " only.")
      .named(std::string(parameter.symbol))
      .in(std::string(parameter.unit))
      .at_least(0.0)
      .otherwise(ErosionParameters{}.*parameter.value);
}

/// Rows of elements in a layer of the column.
Declaration layer(const char* pattern, int LayerSettings::*member, const char* sentence) {
  return key(pattern, rows(member), sentence).at_least(0).at_most(1000).otherwise(0);
}

/// A key the reader itself acts on; the scene keeps nothing of it.
Declaration instruction(const char* pattern, const char* sentence) {
  Declaration d;
  d.pattern = pattern;
  d.kind = ValueKind::text;
  d.sentence = sentence;
  d.store = [](Scene&, std::size_t, const Value&) {};
  return d;
}

// NOLINTNEXTLINE(readability-function-size): one list, which is read from top to bottom
std::vector<SceneKey> declare_keys() {
  using Geometry = GeometrySettings;
  using Layers = LayerSettings;
  using Points = PointSettings;
  using Liquid = LiquidProperties;
  using Boundary = BoundaryCondition;
  return {
      key("name", at(&Scene::name), "What the run is called in figures and reports.")
          .otherwise_as("the file's name"),
      choice("formulation", at(&Scene::formulation),
             {{"single-point", Formulation::single_point},
              {"double-point", Formulation::double_point}},
             "How the two phases are carried: in one set of material points that follows the "
             "solid, or in two, of which the second follows the liquid and carries the fluidised "
             "grains.")
          .mandatory(),
      key("gravity", at(&Scene::gravity),
          "Acceleration of gravity. Without it p is the pressure in excess of the hydrostatic one.")
          .named("g")
          .in("m/s2")
          .otherwise(std::vector{0.0, 0.0}),

      key("geometry.file", at(&Scene::geometry, &Geometry::file),
          "Your own .geo, .msh or .step file, relative to the scene; its physical groups name "
          "regions and boundaries.")
          .otherwise_as("required without `shape`"),
      choice("geometry.shape", at(&Scene::geometry, &Geometry::shape), {{"column", "column"}},
             "A built-in geometry. A column has the region `specimen`, whose lower left corner is "
             "the origin, and the boundaries `top`, `bottom`, `left` and `right`.")
          .otherwise_as("required without `file`"),
      key("geometry.width", at(&Scene::geometry, &Geometry::width), "Width of the column.")
          .in("m")
          .above(0.0)
          .otherwise_as("required with `shape`"),
      key("geometry.height", at(&Scene::geometry, &Geometry::height), "Height of the specimen.")
          .in("m")
          .above(0.0)
          .otherwise_as("required with `shape`"),

      layer("geometry.layers.inflow", &Layers::inflow,
            "Free water on top, region `inflow`: liquid enters there, through the boundary "
            "`inflow`, which takes the place of `top`."),
      layer("geometry.layers.free_above", &Layers::free_above,
            "Free water above the upper buffer, region `free_above`."),
      layer("geometry.layers.above", &Layers::above,
            "Soil on top of the specimen, region `buffer`."),
      layer("geometry.layers.below", &Layers::below,
            "Soil beneath the specimen, region `buffer` too."),
      layer("geometry.layers.free_below", &Layers::free_below,
            "Free water below the lower buffer, region `free_below`."),
      layer("geometry.layers.outflow", &Layers::outflow,
            "Free water at the foot, region `outflow`: liquid leaves there, through the boundary "
            "`outflow`, which takes the place of `bottom`."),

      key("mesh.size", at(&Scene::mesh, &MeshSettings::size),
          "Size of the elements; with a .geo or .step file the largest size, and the one where the "
          "file "
          "gives none.")
          .named("h")
          .in("m")
          .above(0.0)
          .otherwise_as("required with `shape`"),
      choice("mesh.structure", at(&Scene::mesh, &MeshSettings::structure),
             {{"regular", MeshStructure::regular},
              {"crossed", MeshStructure::crossed},
              {"free", MeshStructure::free}},
             "Two right triangles per square; four triangles per quadrangle, cut along its "
             "diagonals; or Gmsh's unstructured triangles. The explicit scheme follows flows that "
             "turn on crossed meshes only.")
          .otherwise_as("`\"regular\"`; with `file`, `\"crossed\"`"),

      key("points.solid_per_element", at(&Scene::points, &Points::solid_per_element),
          "Solid material points in each triangle, at its Gauss points.")
          .one_of({1, 3, 6, 12})
          .otherwise(3),
      key("points.jitter", at(&Scene::points, &Points::jitter),
          "How far solid points are moved off the Gauss positions, as a fraction of the element "
          "size.")
          .at_least(0.0)
          .at_most(0.5)
          .otherwise(0.0),
      key("points.seed", at(&Scene::points, &Points::seed),
          "Seed of the jitter and of random seeding: the same seed gives the same points.")
          .at_least(0)
          .otherwise(1),
      key("points.liquid_per_element", at(&Scene::points, &Points::liquid_per_element),
          "Liquid material points in each triangle; with `equal_volume` in a mean triangle of the "
          "soil that erodes, at the start. With `seeding = \"gauss\"` 1, 3, 6 or 12. Double-point "
          "only.")
          .at_least(1)
          .at_most(1000)
          .otherwise(12),
      choice("points.seeding", at(&Scene::points, &Points::seeding),
             {{"gauss", Seeding::gauss},
              {"random", Seeding::random},
              {"low-discrepancy", Seeding::low_discrepancy}},
             "Where liquid points start: at Gauss points, whose volumes differ as their weights "
             "do; anywhere by chance; or spread as evenly as can be, without repeating a pattern. "
             "Double-point only.")
          .otherwise("low-discrepancy"),
      key("points.equal_volume", at(&Scene::points, &Points::equal_volume),
          "Liquid points stand for equal volumes, up to rounding to whole points: an element with "
          "more liquid has more of them. Otherwise each element has the same number, as it always "
          "has of Gauss points. Double-point only.")
          .otherwise_as("`true`; with `seeding = \"gauss\"`, `false`"),

      key("liquid.density", at(&Scene::liquid, &Liquid::density), "Density of the water.")
          .named("rho_w")
          .in("kg/m3")
          .above(0.0)
          .mandatory(),
      key("liquid.bulk_modulus", at(&Scene::liquid, &Liquid::bulk_modulus),
          "Bulk modulus of the water; the explicit scheme needs a finite one. `inf`: "
          "incompressible.")
          .named("K")
          .in("Pa")
          .above(0.0)
          .or_infinite()
          .mandatory(),
      key("liquid.viscosity", at(&Scene::liquid, &Liquid::viscosity),
          "Dynamic viscosity of the water.")
          .named("mu")
          .in("Pa s")
          .above(0.0)
          .mandatory(),

      instruction("soil.*.like",
                  "Another soil that every key not given here is taken from, erosion included.")
          .otherwise_as("none"),
      key("soil.*.porosity", in_soil(&Soil::porosity),
          "Initial porosity; with a gradient, its value at `porosity_origin`.")
          .named("n_0")
          .above(0.0)
          .below(1.0)
          .mandatory(),
      key("soil.*.porosity_gradient", in_soil(&Soil::porosity_gradient),
          "Gradient of the initial porosity: n_0(x) = porosity + gradient . (x - origin).")
          .named("grad n_0")
          .in("1/m")
          .otherwise(std::vector{0.0, 0.0}),
      key("soil.*.porosity_origin", in_soil(&Soil::porosity_origin),
          "Where the initial porosity is `porosity`, for the gradient.")
          .in("m")
          .otherwise(std::vector{0.0, 0.0}),
      key("soil.*.skeleton_fraction", in_soil(&Soil::skeleton_fraction),
          "Volume fraction of the coarse grains, which never erode; n_0 + n_C <= 1.")
          .named("n_C")
          .above(0.0)
          .below(1.0)
          .mandatory(),
      key("soil.*.grain_density", in_soil(&Soil::grain_density), "Density of the grains.")
          .named("rho_s")
          .in("kg/m3")
          .above(0.0)
          .mandatory(),
      key("soil.*.conductivity", in_soil(&Soil::conductivity),
          "Hydraulic conductivity at the initial porosity, for g = 9.81 m/s2.")
          .named("k")
          .in("m/s")
          .above(0.0)
          .mandatory(),

      choice(
          "soil.*.conductivity_law", in_soil(&Soil::conductivity_law), by_word(conductivity_laws()),
          "How conductivity follows porosity: " +
              chained(texts_of(conductivity_laws(), &ConductivityLaw::description), ", ", ", or ") +
              ".")
          .otherwise(std::string(conductivity_laws().front()->word)),
      choice("soil.*.drag", in_soil(&Soil::drag),
             {{"darcy", SoilDrag::darcy}, {"ergun", SoilDrag::ergun}},
             "Resistance to the flow: Darcy's, or Ergun's, which also grows with the square of the "
             "flux and has Darcy's `conductivity` at small fluxes.")
          .otherwise("darcy"),

      choice("soil.*.erosion.law", in_erosion(&ErosionSettings::law), by_word(erosion_laws()),
             chained(texts_of(erosion_laws(), &ErosionLaw::equation), "; ", "; ") + ".")
          .named("phi_e")
          .otherwise_as("`" + no_erosion_word() + "`; required with any other erosion key"),
      key("soil.*.erosion.rate", in_erosion(&ErosionSettings::rate),
          "Rate of the law: " + listed(rate_symbols()) + ".")
          .named(chained(rate_symbols(), ", ", ", "))
          .in(rate_unit())
          .at_least(0.0)
          .otherwise_as("required unless `law = " + no_erosion_word() + "`"),
      key("soil.*.erosion.start", in_erosion(&ErosionSettings::start), "When erosion starts.")
          .named("t_0")
          .in("s")
          .at_least(0.0)
          .otherwise(0.0),
      key("soil.*.erosion.momentum_transfer", in_erosion(&ErosionSettings::momentum_transfer),
          "Keep rho_s phi_e (v_L - v_S), the momentum eroded grains take up, in the liquid's "
          "momentum.")
          .otherwise(false),
      choice("soil.*.erosion.mass_transfer", in_erosion(&ErosionSettings::mass_transfer),
             {{"nodal", MassTransfer::nodal}, {"element", MassTransfer::element}},
             "Which liquid points take up eroded grains: those around, through the nodes, by their "
             "volumes; or those in the same element, in equal shares. Double-point only.")
          .otherwise("nodal"),
      choice("soil.*.erosion.empty_elements", in_erosion(&ErosionSettings::empty_elements),
             {{"wet", EmptyElements::wet}, {"dry", EmptyElements::dry}},
             "An element that has no liquid point for the moment: erodes like any other, as its "
             "pores are full all the same; or does not erode. Double-point only.")
          .otherwise("wet"),

      key("boundary[].on", on_boundary(&Boundary::on), "Name of the boundary.").mandatory(),
      key("boundary[].pressure", on_boundary(&Boundary::pressure), "Pore pressure there.")
          .named("p")
          .in("Pa")
          .otherwise_as("none"),
      key("boundary[].velocity", on_boundary(&Boundary::velocity),
          "Intrinsic liquid velocity normal to the boundary, positive into the model.")
          .named("v_L")
          .in("m/s")
          .otherwise_as("none"),
      key("boundary[].darcy_flux", on_boundary(&Boundary::darcy_flux),
          "Volume flux of liquid normal to the boundary, positive into the model.")
          .named("q")
          .in("m/s")
          .otherwise_as("none"),
      key("boundary[].concentration", on_boundary(&Boundary::concentration),
          "Fluidised grains per volume of the liquid that enters.")
          .named("c")
          .at_least(0.0)
          .below(1.0)
          .otherwise_as("clean liquid"),

      choice("initial.flow", at(&Scene::initial_flow),
             {{"rest", InitialFlow::rest}, {"steady", InitialFlow::steady}},
             "Flow at the start: at rest, or steady under the boundary conditions.")
          .otherwise("rest"),

      key("flow.porosity_gradient_term", at(&Scene::flow, &FlowSettings::porosity_gradient_term),
          "Keep (v_L - v_S) . grad n_L in the balance of water. Without it water is lost wherever "
          "porosity varies: for comparison only, with the explicit scheme, and not in double-point "
          "scenes.")
          .otherwise(true),
      choice("flow.integration", at(&Scene::flow, &FlowSettings::integration),
             {{"mixed", PressureIntegration::mixed},
              {"material-point", PressureIntegration::material_point}},
             "Where the pressure lives: one per element; or at the liquid points, which then carry "
             "the velocity too. Double-point only; at points with the explicit scheme only.")
          .otherwise("mixed"),

      key("time.end", at(&Scene::time, &TimeSettings::end), "When the run ends.")
          .named("T")
          .in("s")
          .above(0.0)
          .mandatory(),
      choice("time.scheme", at(&Scene::time, &TimeSettings::scheme),
             {{"implicit", FlowScheme::implicit_mixed}, {"explicit", FlowScheme::explicit_nodal}},
             "How the flow is stepped: implicit, with fluxes through faces and pressures of "
             "elements; or explicit, with velocities at nodes.")
          .otherwise("implicit"),
      key("time.step", at(&Scene::time, &TimeSettings::step),
          "Longest time step. The stretch from one output to the next, and to a time at which "
          "erosion or a "
          "boundary value changes its course, is divided into equal steps: 0.0851 s and an output "
          "every second "
          "make 12 steps of 0.0833 s. Column `dt` of history.csv shows the step.")
          .named("dt")
          .in("s")
          .above(0.0)
          .otherwise_as("explicit: 0.9 of the stability limit; implicit: chosen by `tolerance`"),
      choice("time.stepping", at(&Scene::time, &TimeSettings::stepping),
             {{"second-order", TimeStepping::second_order}, {"monotone", TimeStepping::monotone}},
             "Second order in time; or backward Euler, whose pressures stay within those at the "
             "boundaries on meshes without obtuse angles. Implicit only.")
          .otherwise("second-order"),
      key("time.inertia", at(&Scene::time, &TimeSettings::inertia),
          "Keep the liquid's inertia. Implicit only.")
          .otherwise_as("decided from the scene: left out where the time in which flow settles, "
                        "k/(n g), is below 1 % of a given step, or below `tolerance` times `end`; "
                        "where it is kept, waves shorter than that are not followed one by one"),
      key("time.tolerance", at(&Scene::time, &TimeSettings::tolerance),
          "Bound of the local error of a step, relative: of fluxes, of pressures, of what erodes. "
          "Implicit only, and not with `step`.")
          .above(0.0)
          .at_most(0.1)
          .otherwise(1e-3),
      key("time.mass_scaling", at(&Scene::time, &TimeSettings::mass_scaling),
          "Factor on the liquid's inertia that allows larger steps and slows the flow's start-up. "
          "Explicit only.")
          .named("S")
          .at_least(1.0)
          .otherwise(1.0),
      choice("time.drag", at(&Scene::time, &TimeSettings::drag),
             {{"explicit", DragIntegration::explicit_drag},
              {"implicit", DragIntegration::implicit_drag}},
             "How Darcy's drag is stepped within the explicit scheme. Explicit only.")
          .otherwise("explicit"),

      key("output.every", at(&Scene::output, &OutputSettings::every),
          "Time between rows of the tables. A row is the state at the end of a step: every output "
          "ends one.")
          .in("s")
          .above(0.0)
          .mandatory(),
      key("output.snapshot_every", at(&Scene::output, &OutputSettings::snapshot_every),
          "Time between snapshots of the whole state; not below `every`. A snapshot ends a step, "
          "as a row does.")
          .in("s")
          .above(0.0)
          .otherwise_as("`output.every`"),
  };
}

bool within(const SceneKey& key, double x) {
  if (key.lower && (key.lower->open ? x <= key.lower->value : x < key.lower->value)) return false;
  if (key.upper && (key.upper->open ? x >= key.upper->value : x > key.upper->value)) return false;
  return std::isfinite(x) || (key.infinite_allowed && x > 0.0);
}

/// How messages and the reference call a value of this key.
std::string quantity_of(const SceneKey& key) {
  // A list of symbols would not read as one quantity between bounds.
  const bool one_symbol = !key.symbol.empty() && key.symbol.find(',') == std::string::npos;
  return one_symbol ? key.symbol : key.leaf();
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '\n') {
      result += "\\n";
    } else if (c == '"' || c == '\\') {
      result += {'\\', c};
    } else {
      result += c;
    }
  }
  return result + '"';
}

}  // namespace

const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = [] {
    std::vector<SceneKey> all = declare_keys();
    const auto rate = std::ranges::find(all, "soil.*.erosion.rate", &SceneKey::pattern);
    std::vector<SceneKey> of_laws;
    for (const ErosionParameter& p : erosion_parameters()) of_laws.push_back(erosion_parameter(p));
    all.insert(rate + 1, of_laws.begin(), of_laws.end());
    return all;
  }();
  return keys;
}

const std::vector<SceneSection>& scene_sections() {
  static const std::vector<SceneSection> sections = {
      {"", "Top level", "Keys before the first table."},
      {"geometry", "[geometry]", "Either a built-in `shape` or your own `file`."},
      {"geometry.layers", "[geometry.layers]",
       "Rows of elements that a column has beside its specimen, each as high as a row of the "
       "specimen. In this order from top to bottom, the specimen between `above` and `below`. "
       "Double-point only."},
      {"mesh", "[mesh]", "Linear triangles."},
      {"points", "[points]", "Material points."},
      {"liquid", "[liquid]", "Weakly compressible or incompressible water."},
      {"soil.*", "[soil.NAME]",
       "One table per region, NAME being the region's. In double-point scenes the regions "
       "`inflow`, `outflow`, `free_above` and `free_below`, of a column or of your own file, need "
       "none: without a soil they are free water, n_L = 1."},
      {"soil.*.erosion", "[soil.NAME.erosion]",
       "How fines of this soil turn into fluidised grains. n_L,max = 1 - n_C."},
      {"boundary[]", "[[boundary]]",
       "One entry per named boundary, with at most one of `pressure`, `velocity` and `darcy_flux`. "
       "Boundaries without an entry are impervious. Each value is a number, or changes in time: "
       "pairs `[[t, value], ...]`, linear between them, constant before the first and after the "
       "last; two pairs at nearly the same time make a jump."},
      {"initial", "[initial]", "State at the start."},
      {"flow", "[flow]", "Variants of the flow."},
      {"time", "[time]", "Time stepping."},
      {"output", "[output]", "What is written, and when."},
  };
  return sections;
}

const SceneKey* find_scene_key(const std::string& pattern) {
  const auto found = std::ranges::find(scene_keys(), pattern, &SceneKey::pattern);
  return found == scene_keys().end() ? nullptr : &*found;
}

std::vector<std::string> scene_children(const std::string& pattern) {
  std::vector<std::string> children;
  for (const SceneKey& key : scene_keys()) {
    if (!key.pattern.starts_with(pattern)) continue;
    std::string rest = key.pattern.substr(pattern.size());
    if (!pattern.empty()) {
      if (rest.starts_with('.')) {
        rest.erase(0, 1);
      } else if (!rest.starts_with("[]")) {
        continue;
      }
    }
    const std::string child =
        rest.starts_with("[]") ? "[]" : rest.substr(0, rest.find_first_of(".["));
    if (!std::ranges::count(children, child)) children.push_back(child);
  }
  return children;
}

std::string joined(const std::string& parent, const std::string& child) {
  return parent.empty() || child.starts_with('[') ? parent + child : parent + '.' + child;
}

std::string SceneKey::leaf() const {
  return pattern.substr(pattern.rfind('.') + 1);
}

std::string SceneKey::bounds() const {
  const std::string quantity = quantity_of(*this);
  const auto relation = [](const Bound& bound, const char* strict, const char* weak) {
    return std::string(bound.open ? strict : weak);
  };
  if (lower && upper) {
    return shown_number(lower->value) + relation(*lower, " < ", " <= ") + quantity +
           relation(*upper, " < ", " <= ") + shown_number(upper->value);
  }
  if (lower) return quantity + relation(*lower, " > ", " >= ") + shown_number(lower->value);
  if (upper) return quantity + relation(*upper, " < ", " <= ") + shown_number(upper->value);
  return {};
}

std::string SceneKey::expected() const {
  const std::string limits = bounds().empty() ? "" : " with " + bounds();
  const std::string measure = unit.empty() ? "" : ", in " + unit;
  std::vector<std::string> all;
  switch (kind) {
    case ValueKind::text:
      return "a text that is not empty";
    case ValueKind::word:
      for (const std::string& word : words) all.push_back(quoted(word));
      return listed(all);
    case ValueKind::number:
      return "a number" + limits + measure + (infinite_allowed ? ", or inf" : "");
    case ValueKind::time_function:
      return "a number" + limits + measure + ", or pairs [[t, " + quantity_of(*this) +
             "], ...] of times (s, ascending) and such numbers";
    case ValueKind::integer:
      for (const std::int64_t integer : integers) all.push_back(std::to_string(integer));
      return all.empty() ? "an integer" + limits : listed(all);
    case ValueKind::boolean:
      return "true or false";
    case ValueKind::vector:
      return "an array of 2 or 3 numbers" + measure;
  }
  return {};
}

std::optional<Value> SceneKey::accept(const Value& value) const {
  const auto* text = std::get_if<std::string>(&value);
  const auto* integer = std::get_if<std::int64_t>(&value);
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  bool accepted = false;
  switch (kind) {
    case ValueKind::text:
      accepted = text && !text->empty();
      break;
    case ValueKind::word:
      accepted = text && std::ranges::count(words, *text);
      break;
    case ValueKind::integer:
      accepted = integer && std::in_range<int>(*integer) &&
                 within(*this, static_cast<double>(*integer)) &&
                 (integers.empty() || std::ranges::count(integers, *integer));
      break;
    case ValueKind::boolean:
      accepted = std::holds_alternative<bool>(value);
      break;
    case ValueKind::time_function:
      if (const auto* rows = std::get_if<Rows>(&value)) {
        accepted = !rows->empty() && fault(value).empty();
        break;
      }
      [[fallthrough]];
    case ValueKind::number: {
      const auto* real = std::get_if<double>(&value);
      if (!real && !integer) return std::nullopt;
      const double x = real ? *real : static_cast<double>(*integer);
      return within(*this, x) ? std::optional<Value>(x) : std::nullopt;
    }
    case ValueKind::vector:
      accepted = numbers && (numbers->size() == 2 || numbers->size() == 3) &&
                 std::ranges::all_of(*numbers, [](double x) { return std::isfinite(x); });
      break;
  }
  return accepted ? std::optional<Value>(value) : std::nullopt;
}

std::string SceneKey::fault(const Value& value) const {
  const auto* rows = std::get_if<Rows>(&value);
  if (kind != ValueKind::time_function || !rows) return {};
  const std::vector<double>* earlier = nullptr;
  for (const std::vector<double>& row : *rows) {
    if (row.size() != 2) {
      return "entry " + std::to_string(&row - rows->data() + 1) + ", " + shown_value(row);
    }
    std::string time = "t = " + shown_number(row[0]);
    if (!std::isfinite(row[0])) return time;
    if (earlier && row[0] <= earlier->front()) {
      return time + " after t = " + shown_number(earlier->front());
    }
    if (!within(*this, row[1])) {
      return quantity_of(*this) + " = " + shown_number(row[1]) + " at " + time;
    }
    earlier = &row;
  }
  return {};
}

std::string shown_name(const std::string& name) {
  const auto is_bare = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !name.empty() && std::ranges::all_of(name, is_bare) ? name : quoted(name);
}

std::string shown_number(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text(buffer.data(), end);
  // 2e+07 is 2e7 to everybody but printf.
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  const bool negative = text[exponent + 1] == '-';
  const std::size_t digits = text.find_first_not_of("+-0", exponent + 1);
  return text.substr(0, exponent + 1) + (negative ? "-" : "") + text.substr(digits);
}

std::string shown_value(const Value& value) {
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
  if (const auto* real = std::get_if<double>(&value)) {
    const std::string text = shown_number(*real);
    const bool looks_integer = text.find_first_not_of("-0123456789") == std::string::npos;
    return looks_integer ? text + ".0" : text;
  }
  std::string text;
  const auto add = [&text](const Value& item) {
    text += (text.empty() ? "" : ", ") + shown_value(item);
  };
  if (const auto* rows = std::get_if<Rows>(&value)) {
    for (const auto& row : *rows) add(row);
  } else {
    for (const double x : std::get<std::vector<double>>(value)) add(x);
  }
  return '[' + text + ']';
}

std::string listed(const std::vector<std::string>& items, const std::string& last_joint) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? ' ' + last_joint + ' ' : ", ";
    text += items[i];
  }
  return text;
}

}  // namespace suffuse
