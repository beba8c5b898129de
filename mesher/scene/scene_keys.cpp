#include <cmath>

#include "scene/check_keys.hpp"
#include "scene/law_texts.hpp"
#include "scene/scene_declaration.hpp"

namespace suffuse {
namespace {

using namespace declaration;

/// A member of the liquid's viscosity model.
template <class Member>
auto in_viscosity(Member ViscosityModel::*member) {
  return at(&Scene::liquid, &LiquidProperties::viscosity_model, member);
}

/// A member of the field of a soil's conductivity.
template <class Member>
auto in_field(Member FieldModel::*member) {
  return [=](Scene& scene, std::size_t i) -> Member& { return scene.soils[i].field.*member; };
}

/// Storage of a number of rows of elements next to the specimen.
auto rows(int LayerSettings::*member) {
  return at(&Scene::geometry, &GeometrySettings::layers, member);
}

/// All laws, as the meanings of their words.
template <class Law>
std::vector<std::pair<std::string, const Law*>> by_word(std::span<const Law* const> laws) {
  std::vector<std::pair<std::string, const Law*>> meanings;
  for (const Law* law : laws) meanings.emplace_back(law->word, law);
  return meanings;
}

std::string no_erosion_word() {
  return shown_value(std::string(no_erosion()->word));
}

/// Declares a parameter of some conductivity laws.
Declaration conductivity_parameter(const ConductivityParameter& parameter) {
  const auto access = [value = parameter.value](Scene& scene, std::size_t i) -> double& {
    return scene.soils[i].conductivity_parameters.*value;
  };
  const std::string laws = listed(laws_with_conductivity_parameter(parameter.key), "and");
  Declaration d = key("soil.*." + std::string(parameter.key), access,
                      std::string(parameter.sentence) + " Of the law " + laws + ".")
                      .named(std::string(parameter.symbol))
                      .above(parameter.above);
  const double standard = ConductivityParameters{}.*parameter.value;
  return std::isnan(standard) ? std::move(d).otherwise_as("required by its law")
                              : std::move(d).otherwise(standard);
}

/// Declares a parameter of some retention laws. It has no default.
Declaration retention_parameter(const RetentionParameter& parameter) {
  const auto access = [value = parameter.value](Scene& scene, std::size_t i) -> double& {
    return scene.soils[i].retention.parameters.*value;
  };
  const std::string laws = listed(laws_with_retention_parameter(parameter.key), "and");
  return key("soil.*.retention." + std::string(parameter.key), access,
             std::string(parameter.sentence) + " Of the model " + laws + ".")
      .named(std::string(parameter.symbol))
      .in(std::string(parameter.unit))
      .above(parameter.above)
      .otherwise_as("required by its model");
}

/// The laws, and the word for no law, which a soil that is `like` another may need.
std::vector<std::pair<std::string, const RetentionLaw*>> retention_meanings() {
  auto meanings = by_word(retention_laws());
  meanings.insert(meanings.begin(), {"none", nullptr});
  return meanings;
}

/// Declares a parameter of some laws of the skeleton.
Declaration skeleton_parameter(const SkeletonParameter& parameter) {
  std::vector<std::string> laws = laws_with_skeleton_parameter(parameter.key);
  const bool of_all = laws.size() == skeleton_laws().size();
  Declaration d = key("soil.*.skeleton." + std::string(parameter.key), in_skeleton(parameter.value),
                      std::string(parameter.sentence) +
                          (of_all ? "" : " Of the law " + listed(laws, "and") + "."))
                      .named(std::string(parameter.symbol))
                      .in(std::string(parameter.unit));
  d.lower = Bound{parameter.lower, !parameter.lower_allowed};
  if (std::isfinite(parameter.upper)) d.upper = Bound{parameter.upper, true};
  if (!parameter.follows_fines) d.kind = ValueKind::number;
  Declaration whole = parameter.follows_fines ? std::move(d).of_fines() : std::move(d);
  return parameter.required ? std::move(whole).otherwise_as("required by its law")
                            : std::move(whole).otherwise(0.0);
}

/// The laws, and the word for a skeleton that does not move.
std::vector<std::pair<std::string, const SkeletonLaw*>> skeleton_meanings() {
  auto meanings = by_word(skeleton_laws());
  meanings.insert(meanings.begin(), {"rigid", nullptr});
  return meanings;
}

/// Declares the initial stress: `"gravity"`, or K_0.
Declaration initial_stress() {
  Declaration d = key("initial.stress", at(&Scene::earth_pressure),
                      "Effective stress at the start: equilibrium under gravity, from which "
                      "displacements count; or K_0, horizontal over vertical stress, with the "
                      "vertical stress of level ground.");
  d.kind = ValueKind::number_or_word;
  d.words = {"gravity"};
  d.store = [](Scene& scene, std::size_t, const Value& value) {
    const auto* ratio = std::get_if<double>(&value);
    scene.earth_pressure = ratio ? std::optional(*ratio) : std::nullopt;
  };
  return d;
}

/// Declares the conductivity: one number in all directions, or one along and one across bedding.
Declaration conductivity() {
  Declaration d = key("soil.*.conductivity", in_soil(&Soil::conductivity),
                      "Hydraulic conductivity at the initial porosity, for g = 9.81 m/s2: the same "
                      "in all directions, or along and across bedding.");
  d.kind = ValueKind::number_or_pair;
  d.store = [](Scene& scene, std::size_t i, const Value& value) {
    const auto* pair = std::get_if<std::vector<double>>(&value);
    scene.soils[i].conductivity = pair ? pair->front() : std::get<double>(value);
    scene.soils[i].conductivity_across = pair ? pair->back() : unset;
  };
  return d;
}

/// Declares the correlation lengths of a conductivity that varies: one number, or one along and one
/// across bedding.
Declaration correlation() {
  Declaration d = key(
      "soil.*.field.correlation",
      [](Scene& scene, std::size_t i) -> double& { return scene.soils[i].field.along; },
      "Distance at which the correlation of ln k has fallen to 1/e, exp(-(r/l)^2): "
      "the same in all directions, or along and across bedding. Elements should be "
      "smaller than a third of it.");
  d.kind = ValueKind::number_or_pair;
  d.store = [](Scene& scene, std::size_t i, const Value& value) {
    const auto* pair = std::get_if<std::vector<double>>(&value);
    FieldModel& field = scene.soils[i].field;
    field.along = pair ? pair->front() : std::get<double>(value);
    field.across = pair ? pair->back() : field.along;
  };
  return d;
}

/// Declares the number of rows of elements in a layer of the column.
Declaration layer(const char* pattern, int LayerSettings::*member, const char* sentence) {
  return key(pattern, rows(member), sentence).at_least(0).at_most(1000).otherwise(0);
}

/// Declares a key that only the reader uses; the scene does not store it.
Declaration instruction(const char* pattern, const char* sentence) {
  Declaration d;
  d.pattern = pattern;
  d.kind = ValueKind::text;
  d.sentence = sentence;
  d.store = [](Scene&, std::size_t, const Value&) {};
  return d;
}

/// Declares an `instruction` that is true or false.
Declaration switch_of(const char* pattern, const char* sentence) {
  Declaration d = instruction(pattern, sentence);
  d.kind = ValueKind::boolean;
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
      key("geometry.scale", at(&Scene::geometry, &Geometry::scale),
          "Metres per unit of length of a .geo or .msh `file`: 0.001 where it is in millimetres. "
          "Sizes that a .geo file gives are in its unit, `mesh.size` and all else in the scene in "
          "metres. A .step file states its own unit.")
          .in("m")
          .at_least(1e-9)
          .at_most(1e6)
          .otherwise(1.0),
      choice("geometry.shape", at(&Scene::geometry, &Geometry::shape),
             {{"column", "column"}, {"box", "box"}},
             "A built-in geometry. A column, in two dimensions, has the region `specimen`, whose "
             "lower left corner is the origin, and the boundaries `top`, `bottom`, `left` and "
             "`right`. A box is the same of tetrahedra: x goes from left to right, y from front to "
             "back, z upwards, and has the boundaries `front` and `back` too.")
          .otherwise_as("required without `file`"),
      key("geometry.width", at(&Scene::geometry, &Geometry::width), "Width along x.")
          .in("m")
          .above(0.0)
          .otherwise_as("required with `shape`"),
      key("geometry.depth", at(&Scene::geometry, &Geometry::depth), "Depth of a box, along y.")
          .in("m")
          .above(0.0)
          .otherwise_as("required with `shape = \"box\"`"),
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
          "file gives none. Not with a .msh file. With `suffuse-mesher --sizes` the sizes of that "
          "file hold instead.")
          .named("h")
          .in("m")
          .above(0.0)
          .otherwise_as("with `shape`, and with a file without sizes of its own, a size that makes "
                        "about 20 000 elements, which the summary says"),
      choice("mesh.structure", at(&Scene::mesh, &MeshSettings::structure),
             {{"regular", MeshStructure::regular},
              {"crossed", MeshStructure::crossed},
              {"free", MeshStructure::free}},
             "Two right triangles per square, six tetrahedra per cuboid; four triangles per "
             "quadrangle, cut along its diagonals, in two dimensions only; or Gmsh's unstructured "
             "elements. The explicit scheme follows flows that turn on crossed meshes only. Not "
             "with a .msh file.")
          .otherwise_as("`\"regular\"`; with `file`, `\"crossed\"` or, of volumes, `\"free\"`"),
      key("mesh.error", at(&Scene::mesh, &MeshSettings::error),
          "Mesh again until the discharge of the steady flow is known to this share of it: `make "
          "-C workflows adapt`; with `OVER=run` to this share of the largest discharge of the run. "
          "Implicit scheme only; not with a regular mesh or a .msh file.")
          .named("eps")
          .above(0.0)
          .below(1.0)
          .otherwise_as("the mesh is made once; without `mesh.size` too, `make study` and `make "
                        "sweep` take 0.01"),
      key("mesh.max_elements", at(&Scene::mesh, &MeshSettings::max_elements),
          "Number of elements at which meshing again for `mesh.error` stops.")
          .at_least(1)
          .at_most(5e6)
          .otherwise(200000),

      key("points.solid_per_element", at(&Scene::points, &Points::solid_per_element),
          "Solid material points in each element, at its Gauss points: 1, 3, 6 or 12 in a "
          "triangle, 1, 4 or 14 in a tetrahedron.")
          .one_of({1, 3, 4, 6, 12, 14})
          .otherwise_as("3 in a triangle, 4 in a tetrahedron"),
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
          "Liquid material points in each element; with `equal_volume` in a mean element of the "
          "soil that erodes, at the start. With `seeding = \"gauss\"` as many as "
          "`solid_per_element` can be. Double-point only.")
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
          "incompressible, as water always is where soil with a retention moves.")
          .named("K")
          .in("Pa")
          .above(0.0)
          .or_infinite()
          .mandatory(),
      key("liquid.viscosity", at(&Scene::liquid, &Liquid::viscosity),
          "Dynamic viscosity of the water.")
          .named("mu_0")
          .in("Pa s")
          .above(0.0)
          .mandatory(),
      choice("liquid.viscosity_law", in_viscosity(&ViscosityModel::law), by_word(viscosity_laws()),
             "How the viscosity of the liquid follows the fluidised grains in it: " +
                 chained(texts_of(viscosity_laws(), &ViscosityLaw::description), "; ", "; or ") +
                 ".")
          .otherwise(std::string(viscosity_laws().front()->word)),
      key("liquid.maximum_concentration", in_viscosity(&ViscosityModel::maximum_concentration),
          "Concentration at which the grains lock. Of the law \"krieger-dougherty\".")
          .named("c_m")
          .above(0.0)
          .below(1.0)
          .otherwise(0.62),

      instruction("soil.*.like",
                  "Another soil that every key not given here is taken from, erosion included.")
          .otherwise_as("none"),
      switch_of("soil.*.free",
                "true: the region has no soil but is free, as `free_above` is without one; the "
                "other keys of the table are not used. It is a pit to be dug or a place to be "
                "filled in a run `initial.from` another. In double-point scenes, and where a "
                "skeleton moves.")
          .otherwise(false),
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
          "Volume fraction of the coarse grains, which never erode; n_0 + n_C <= 1. Without it "
          "n_C = (1 - n_0)(1 - F*): F* is the share of fines that follows from the gradation, "
          "where H/F is smallest.")
          .named("n_C")
          .above(0.0)
          .below(1.0)
          .mandatory_without("gradation"),
      key("soil.*.gradation", in_soil(&Soil::gradation),
          "Sizes of the grains, linear over log d between points: whether fines can move between "
          "the coarse grains, and how many are loose. The solver has no use for it but this.")
          .named("F(d)")
          .in("mm, %")
          .otherwise_as("none"),
      key("soil.*.grain_density", in_soil(&Soil::grain_density), "Density of the grains.")
          .named("rho_s")
          .in("kg/m3")
          .above(0.0)
          .mandatory(),
      conductivity().named("k").in("m/s").above(0.0).mandatory(),
      key("soil.*.bedding", in_soil(&Soil::bedding),
          "Angle of the bedding from the x-axis, counter-clockwise; in three dimensions it dips "
          "along x alone. With a pair of conductivities only.")
          .in("degrees")
          .at_least(-180.0)
          .at_most(180.0)
          .otherwise(0.0),

      choice(
          "soil.*.conductivity_law", in_soil(&Soil::conductivity_law), by_word(conductivity_laws()),
          "How conductivity follows porosity: " +
              chained(texts_of(conductivity_laws(), &ConductivityLaw::description), ", ", ", or ") +
              ".")
          .otherwise(std::string(conductivity_laws().front()->word)),
      choice("soil.*.drag", in_soil(&Soil::drag),
             {{"darcy", SoilDrag::darcy}, {"ergun", SoilDrag::ergun}},
             "Resistance to the flow: Darcy's, or Ergun's, which also grows with the square of the "
             "flux and has Darcy's `conductivity` at small fluxes. Not with a retention law, nor "
             "with boundaries whose faces open, close or fall dry.")
          .otherwise("darcy"),

      choice("soil.*.erosion.law", in_erosion(&ErosionSettings::law), by_word(erosion_laws()),
             "The state: " + described(erosion_laws(), &ErosionLaw::equation) + ".")
          .named("phi_e")
          .otherwise_as("`" + no_erosion_word() + "`; required with any other erosion key"),
      key("soil.*.erosion.rate", in_erosion(&ErosionSettings::rate),
          "Rate of the law: " + listed(rate_symbols()) + ". Its unit is that of the drive.")
          .named(chained(rate_symbols(), ", ", ", "))
          .in(rate_unit())
          .at_least(0.0)
          .otherwise_as("required unless `law = " + no_erosion_word() + "`"),
      choice("soil.*.erosion.drive", in_erosion(&ErosionSettings::drive), by_word(drive_laws()),
             "What makes fines leave: " + described(drive_laws(), &DriveLaw::equation) +
                 ". The law \"flux\" has its own.")
          .named("D")
          .otherwise(std::string(drive_laws().front()->word)),
      key("soil.*.erosion.threshold", in_erosion(&ErosionSettings::threshold),
          "Drive below which nothing erodes. Not with the drive \"time\".")
          .named("D_cr")
          .in(threshold_unit())
          .at_least(0.0)
          .otherwise(0.0),
      key("soil.*.erosion.residual", in_erosion(&ErosionSettings::residual),
          "Erodible fraction that stays whatever the drive: one number, or as it goes with the "
          "flux, linear between the pairs.")
          .named("n_e")
          .of_argument("|q|", "fluxes (m/s, ascending)")
          .at_least(0.0)
          .below(1.0)
          .otherwise(0.0),
      key("soil.*.erosion.critical_concentration",
          in_erosion(&ErosionSettings::critical_concentration),
          "Concentration of the liquid at which nothing erodes any more.")
          .named("c_cr")
          .above(0.0)
          .below(1.0)
          .or_infinite()
          .otherwise_as("`inf`"),
      key("soil.*.erosion.length", in_erosion(&ErosionSettings::length),
          "Length over which the law averages the flux, of the size of some large grains: it gives "
          "channels a width that does not depend on the mesh. 0: the flux of the place. Rigid soil "
          "only, and not with the drive \"time\".")
          .named("l")
          .in("m")
          .at_least(0.0)
          .otherwise(0.0),
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

      key("soil.*.deposition.coefficient", in_deposition(&DepositionModel::coefficient),
          "Share of the grains in the liquid that is caught per length of path.")
          .named("lambda_d")
          .in("1/m")
          .at_least(0.0)
          .otherwise_as("required with any other deposition key"),
      key("soil.*.deposition.porosity_min", in_deposition(&DepositionModel::porosity_min),
          "Porosity at which no room is left: what is caught goes with (n_L - n_min) / (n_0 - "
          "n_min). Without it there is always room.")
          .named("n_min")
          .above(0.0)
          .below(1.0)
          .otherwise_as("none"),
      key("soil.*.deposition.flux_max", in_deposition(&DepositionModel::flux_max),
          "Flux from which on nothing is caught.")
          .named("|q|")
          .in("m/s")
          .above(0.0)
          .or_infinite()
          .otherwise_as("`inf`"),

      key("soil.*.field.variation", in_field(&FieldModel::variation),
          "Standard deviation of the conductivity over its mean, `conductivity`: the conductivity "
          "is a lognormal field.")
          .above(0.0)
          .at_most(10.0)
          .otherwise_as("required with any other key of the field"),
      correlation().named("l").in("m").above(0.0).otherwise_as("required with `variation`"),
      key("soil.*.field.seed", in_field(&FieldModel::seed),
          "Number of the draw: the same seed gives the same field on any mesh.")
          .at_least(0)
          .at_most(2147483647)
          .otherwise(1),

      choice("soil.*.retention.model", in_retention(&RetentionModel::law), retention_meanings(),
             chained(texts_of(retention_laws(), &RetentionLaw::description), "; ", "; ") +
                 "; or saturated at any pressure.")
          .otherwise_as("`\"none\"`; required with any other retention key"),
      key("soil.*.retention.residual_saturation",
          in_retention(&RetentionModel::residual_saturation),
          "Liquid per pore volume that stays at any suction.")
          .named("S_r")
          .at_least(0.0)
          .below(1.0)
          .otherwise(0.0),

      choice(
          "soil.*.skeleton.law", in_skeleton(&SkeletonModel::law), skeleton_meanings(),
          described(skeleton_laws(), &SkeletonLaw::description) + "; \"rigid\": it does not move.")
          .otherwise_as("`\"rigid\"`; required with any other skeleton key"),

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
      key("boundary[].head", on_boundary(&Boundary::head),
          "Head of the water outside: its level above the datum. Without gravity p = rho_w g H "
          "with g = 9.81 m/s2, the excess head.")
          .named("H")
          .in("m")
          .otherwise_as("none"),
      instruction("boundary[].file",
                  "Table of the head in place of `head`: a CSV file, relative to the scene, with "
                  "the columns t (s) and head (m) and the header line `t,head`.")
          .otherwise_as("none"),
      key("boundary[].reservoir_area", on_boundary(&Boundary::reservoir_area),
          "Area of the water table of a reservoir, in 2D per m of thickness. Its level is `head` "
          "at "
          "the start, falls where water seeps into the soil and rises where it seeps out.")
          .named("A")
          .in("m2")
          .above(0.0)
          .otherwise_as("none: `head` holds whatever seeps"),
      choice("boundary[].dry", on_boundary(&Boundary::dry),
             {{"seepage", DryPart::seepage},
              {"impervious", DryPart::impervious},
              {"suction", DryPart::suction}},
             "What holds above the water level of `head`: a seepage face; no flow; or the suction "
             "rho_w g (H - z). Under gravity only.")
          .otherwise("seepage"),
      key("boundary[].seepage_face", on_boundary(&Boundary::seepage_face),
          "Air outside: lets water out at p = 0, and none in.")
          .otherwise(false),
      key("boundary[].rain", on_boundary(&Boundary::rain),
          "Volume flux of rain normal to the boundary, of which the soil takes in as much as it "
          "can at p = 0; the rest runs off.")
          .in("m/s")
          .at_least(0.0)
          .otherwise_as("none"),
      key("boundary[].concentration", on_boundary(&Boundary::concentration),
          "Fluidised grains per volume of the liquid that enters.")
          .named("c")
          .at_least(0.0)
          .below(1.0)
          .otherwise_as("clean liquid"),

      choice("boundary[].fix", on_boundary(&Boundary::fix),
             {{"none", Fixing::none}, {"normal", Fixing::normal}, {"both", Fixing::both}},
             "Whether the soil there can move: in any direction; along the boundary only; or not "
             "at all.")
          .otherwise("none"),
      key("boundary[].traction", on_boundary(&Boundary::traction),
          "Force per area on the soil there, with the pressure of the liquid in it, in the "
          "directions of the axes: a load of 10 kPa on level ground is `[0.0, -1.0e4]`.")
          .in("Pa")
          .otherwise_as("the pressure of the water outside of a `head`; else none"),

      key("wall[].on", in_list(&Scene::walls, &Wall::on),
          "Name of a curve inside the mesh, along which the mesh is cut.")
          .mandatory(),
      key("wall[].conductance", in_list(&Scene::walls, &Wall::conductance),
          "Flux through the wall per difference of head across it: conductivity over thickness.")
          .in("1/s")
          .at_least(0.0)
          .otherwise(0.0),

      key("well[].on", on_boundary(&Boundary::on),
          "Name of a curve or a point inside the mesh. At a point the mesh is cut along two edges, "
          "2 a long in all, that lie nearly in line: a well of radius a/2. The mesher shows the "
          "length "
          "of both sides, 4 a, an eighth of which is the radius.")
          .mandatory(),
      key("well[].head", on_boundary(&Boundary::head),
          "Head in the well. Above its level the well is a seepage face.")
          .named("H")
          .in("m")
          .otherwise_as("none"),
      key("well[].rate", on_boundary(&Boundary::rate),
          "Volume that enters the model through all of the well per time, per metre of thickness: "
          "negative for a well that is pumped. Soils share it by their conductivities at the "
          "start.")
          .named("Q")
          .in("m3/s")
          .otherwise_as("none"),
      key("well[].seepage_face", on_boundary(&Boundary::seepage_face),
          "A drain pipe: lets water out at p = 0, and none in.")
          .otherwise(false),
      key("well[].concentration", on_boundary(&Boundary::concentration),
          "Fluidised grains per volume of the liquid that enters.")
          .named("c")
          .at_least(0.0)
          .below(1.0)
          .otherwise_as("clean liquid"),

      choice("initial.flow", at(&Scene::initial_flow),
             {{"rest", InitialFlow::rest}, {"steady", InitialFlow::steady}},
             "Flow at the start: at rest, or steady under the boundary conditions.")
          .otherwise("rest"),
      key("initial.water_level", at(&Scene::water_level),
          "Level of the liquid at rest, p = rho_w g (level - z), with suction above it. Without "
          "gravity p = rho_w g level everywhere, with g = 9.81 m/s2.")
          .in("m")
          .otherwise_as("the head of the boundaries that have one at t = 0; where they differ or "
                        "there is none, p = 0 without gravity, **required** under gravity at rest"),

      initial_stress().named("K_0").above(0.0).otherwise_as("`\"gravity\"`"),

      key("initial.from", at(&Scene::initial_from),
          "Folder with the results of a run that is done, relative to the scene's folder: its last "
          "state is the initial one here, and the clock starts at 0 again. On the same mesh and "
          "points, with the same water, porosities, grains and retentions; boundaries, other laws, "
          "gravity and the time scheme may differ. Soil that has moved goes on from its place and "
          "its stress, and displacements count from here; a region that has a soil in one scene "
          "and is free in the other is dug out or filled in, single-point only.")
          .otherwise_as("the state of `initial.flow`, with what the soils say"),
      key("initial.construction", at(&Scene::construction),
          "Time over which soil is unloaded where regions were dug out after the run that this one "
          "starts from, and loaded where they were filled in.")
          .in("s")
          .above(0.0)
          .otherwise_as("1 % of `time.end`"),

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
          .otherwise_as("`\"second-order\"`; where a soil has a `retention`, `\"monotone\"`"),
      choice("time.transport", at(&Scene::time, &TimeSettings::transport),
             {{"implicit", TransportScheme::implicit_sweeps},
              {"explicit", TransportScheme::explicit_steps}},
             "How fluidised fines are carried: implicit, in steps of any length, together with "
             "what solid and liquid exchange; or explicit, in steps within which no fines cross "
             "more than an element. Single-point only; implicit with the implicit scheme only.")
          .otherwise_as("explicit; implicit while the flow is so fast that the run would take more "
                        "than 2000 explicit steps"),
      key("time.inertia", at(&Scene::time, &TimeSettings::inertia),
          "Keep the liquid's inertia. Implicit only.")
          .otherwise_as("decided from the scene: left out where the time in which flow settles, "
                        "k/(n g), is below 1 % of a given step, or below `tolerance` times `end`; "
                        "where it is kept, waves shorter than that are not followed one by one"),
      key("time.tolerance", at(&Scene::time, &TimeSettings::tolerance),
          "Bound of the local error of a step, relative: of fluxes, of pressures, of what erodes; "
          "where a soil has a `retention`, of the volume of liquid in a wrong place over the "
          "volume of all pores. In a step a boundary value changes by its root, of the range, at "
          "most. Implicit only, and not with `step`.")
          .above(0.0)
          .at_most(0.1)
          .otherwise(1e-3),
      choice(
          "time.failure", at(&Scene::time, &TimeSettings::failure),
          {{"stop", AtFailure::stop}, {"follow", AtFailure::follow}},
          "When soil whose skeleton moves loses its equilibrium, or has none at the start: stop, "
          "with exit code 3 and the last equilibrium, if any, as the last snapshot; or follow it "
          "with "
          "its inertia, until it has come to rest.")
          .otherwise_as("follow where a single-point scene has regions of free water; stop where "
                        "there is no room for the soil"),
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
          "Time between rows of the tables. The solver ends a step at the time of each row.")
          .in("s")
          .above(0.0)
          .mandatory(),
      key("output.snapshot_every", at(&Scene::output, &OutputSettings::snapshot_every),
          "Time between snapshots of the whole state, at least `every`. The solver ends a step at "
          "the time of each snapshot.")
          .in("s")
          .above(0.0)
          .otherwise_as("`output.every`"),
      key("output.failure_every", at(&Scene::output, &OutputSettings::failure_every),
          "Time between rows and snapshots while soil that has lost its equilibrium moves, in "
          "addition to those above: a slide takes seconds of a flood of days. Where steps are "
          "longer, each step is written. With `time.failure = \"follow\"`.")
          .in("s")
          .above(0.0)
          .otherwise_as("no others than those above"),
      key("output.restarts", at(&Scene::output, &OutputSettings::restarts),
          "Snapshots behind which the run can go on, the newest ones. Their states take more room "
          "than the fields; those of older snapshots are removed.")
          .at_least(1)
          .at_most(1000000)
          .otherwise(2),
      choice("output.precision", at(&Scene::output, &OutputSettings::precision),
             {{"float64", FieldPrecision::float64}, {"float32", FieldPrecision::float32}},
             "How fields are stored in snapshots: with all digits, or with seven, in less than "
             "half the room. Tables, places and the state to go on from keep all digits.")
          .otherwise("float64"),
      key("output.probe[].at", in_output(&OutputSettings::probes, &OutputProbe::at),
          "Where pressure and flux are recorded, inside the mesh.")
          .in("m")
          .mandatory(),
      key("output.probe[].disc", in_output(&OutputSettings::probes, &OutputProbe::disc),
          "With `mesh.error`: radius of the disc around the probe (in 3D a ball) over which head "
          "and gradient are averaged for the columns that say how far they can be off. The disc is "
          "larger where its element is.")
          .in("m")
          .above(0.0)
          .otherwise_as("a fiftieth of the size of the model, the root of its area"),
      key("output.section[].from", in_output(&OutputSettings::sections, &OutputSection::from),
          "Where a line begins through which the discharge is recorded, positive from its left to "
          "its right as one looks along it.")
          .in("m")
          .mandatory(),
      key("output.section[].to", in_output(&OutputSettings::sections, &OutputSection::to),
          "Where the line ends.")
          .in("m")
          .mandatory(),
  };
}

}  // namespace

const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = [] {
    std::vector<SceneKey> all = declare_keys();
    const auto insert_after = [&](const std::string& pattern, std::vector<SceneKey> of_laws) {
      const auto place = std::ranges::find(all, pattern, &SceneKey::pattern) + 1;
      all.insert(place, of_laws.begin(), of_laws.end());
    };
    std::vector<SceneKey> of_conductivity;
    for (const auto& p : conductivity_parameters()) {
      of_conductivity.push_back(conductivity_parameter(p));
    }
    insert_after("soil.*.conductivity_law", std::move(of_conductivity));
    std::vector<SceneKey> of_retention;
    for (const auto& p : retention_parameters()) of_retention.push_back(retention_parameter(p));
    insert_after("soil.*.retention.model", std::move(of_retention));
    std::vector<SceneKey> of_skeleton;
    for (const auto& p : skeleton_parameters()) of_skeleton.push_back(skeleton_parameter(p));
    insert_after("soil.*.skeleton.law", std::move(of_skeleton));
    const std::vector<SceneKey> of_checks = check_keys();
    all.insert(all.end(), of_checks.begin(), of_checks.end());
    return all;
  }();
  return keys;
}

}  // namespace suffuse
