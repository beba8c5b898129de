#pragma once

/// The scene as the programs use it: typed, checked, defaults filled in. Keys, bounds and units are
/// declared in `scene_keys.cpp`; `docs/reference/scene-reference.md` is generated from there.
/// SI units throughout.

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "physics/exchange.hpp"
#include "physics/retention/retention_law.hpp"
#include "physics/skeleton/skeleton_model.hpp"
#include "scene/check_settings.hpp"
#include "scene/gradation.hpp"
#include "scene/lognormal_field.hpp"
#include "scene/time_function.hpp"

namespace suffuse {

enum class Formulation { single_point, double_point };
enum class MeshStructure { regular, crossed, free };
enum class FlowScheme { explicit_nodal, implicit_mixed };
/// Action when the soil loses its equilibrium: the run stops, or follows the failure with the
/// soil's inertia; `by_room`: it follows if the mesh has space for the moving soil.
enum class AtFailure { by_room, stop, follow };
enum class TimeStepping { second_order, monotone };
/// Transport of fluidised fines on the mesh; `by_count`: by the number of explicit steps.
enum class TransportScheme { by_count, implicit_sweeps, explicit_steps };
enum class DragIntegration { explicit_drag, implicit_drag };
enum class InitialFlow { rest, steady };
enum class Seeding { gauss, random, low_discrepancy };
/// Condition of a boundary with a head above its water level.
enum class DryPart { seepage, impervious, suction };
/// Directions in which the soil at a boundary is fixed: normal to it, or all.
enum class Fixing { none, normal, both };
enum class SoilDrag { darcy, ergun };
enum class MassTransfer { nodal, element };
enum class EmptyElements { wet, dry };
enum class PressureIntegration { mixed, material_point };

/// Rows of elements added to the column, from its ends outwards: soil that does not erode, free
/// water, and free water through which liquid enters and leaves.
struct LayerSettings {
  int inflow = 0;
  int free_above = 0;
  int above = 0;
  int below = 0;
  int free_below = 0;
  int outflow = 0;
};

struct GeometrySettings {
  std::string file;       ///< .geo, .msh or .step, relative to the scene; empty with `shape`
  std::string shape;      ///< "column" or "box"; empty with `file`
  double width = unset;   ///< m
  double depth = unset;   ///< m, of a box
  double height = unset;  ///< m
  LayerSettings layers;
  double scale = 1.0;  ///< metres per unit of length of `file`

  [[nodiscard]] bool is_box() const { return shape == "box"; }
};

struct MeshSettings {
  double size = unset;  ///< element size, m; may stay unset with a `file`
  MeshStructure structure = MeshStructure::regular;
  std::optional<double> error = {};  ///< of the discharge, relative: mesh again until it is met
  int max_elements = 200000;         ///< where meshing again stops
};

struct PointSettings {
  int solid_per_element = 3;  ///< 1, 3, 6 or 12; of tetrahedra 1, 4 or 14
  double jitter = 0.0;  ///< points moved off the Gauss positions, as a fraction of the element size
  int seed = 1;         ///< for the jitter and for random seeding
  int liquid_per_element = 12;  ///< double-point: in an element of the specimen at the start
  Seeding seeding = Seeding::low_discrepancy;  ///< for liquid points
  /// Liquid points have equal volumes, and their number in an element is proportional to its liquid
  /// volume; false: equal numbers in all elements, as in the paper. After reading it is false for
  /// Gauss points, whose volumes differ.
  bool equal_volume = true;
};

struct LiquidProperties {
  double density = unset;       ///< rho_w, kg/m3
  double bulk_modulus = unset;  ///< K, Pa; infinite: incompressible (implicit scheme only)
  double viscosity = unset;     ///< mu_0 without fines, Pa s
  ViscosityModel viscosity_model{viscosity_laws().front(), 0.62};
};

struct ErosionSettings {
  const ErosionLaw* law = no_erosion();  ///< never null
  double rate = 0.0;                     ///< in the `rate_unit` of the drive
  double start = 0.0;                    ///< t_0, s
  bool momentum_transfer = false;        ///< keep rho_s phi_e (v_L - v_S) in the liquid's momentum
  MassTransfer mass_transfer =
      MassTransfer::nodal;  ///< double-point: which points take up eroded fines
  EmptyElements empty_elements =
      EmptyElements::wet;                        ///< double-point: erode without liquid points?
  const DriveLaw* drive = drive_laws().front();  ///< never null
  double threshold = 0.0;                        ///< D_cr, in the unit of the drive
  ResidualFraction residual = {};                ///< n_e that does not erode
  double critical_concentration = std::numeric_limits<double>::infinity();  ///< c_cr
  double length = 0.0;                                                      ///< l, m; 0: none
};

struct Soil {
  std::string region;                         ///< name of the region it fills
  double porosity = unset;                    ///< n_0 at `porosity_origin`
  std::array<double, 3> porosity_gradient{};  ///< 1/m: n_0(x) = porosity + gradient . (x - origin)
  std::array<double, 3> porosity_origin{};    ///< m
  double skeleton_fraction = unset;           ///< n_C; given, or from the gradation
  Gradation gradation;                        ///< empty: not given
  double grain_density = unset;               ///< rho_s, kg/m3
  double conductivity = unset;                ///< k at the initial porosity along bedding, m/s
  double conductivity_across = unset;         ///< across bedding, m/s; unset: as along bedding
  double bedding = 0.0;                       ///< angle of bedding from the x-axis, degrees
  RetentionModel retention;                   ///< without a law: saturated at any pressure
  const ConductivityLaw* conductivity_law = conductivity_laws().front();  ///< never null
  ConductivityParameters conductivity_parameters;
  FieldModel field;  ///< how the conductivity varies about `conductivity`, its mean
  SoilDrag drag = SoilDrag::darcy;
  ErosionSettings erosion;
  DepositionModel deposition;
  SkeletonModel skeleton;  ///< without a law: rigid

  /// Whether air can enter the pores.
  [[nodiscard]] bool drains() const { return retention.law != nullptr; }
  /// k across over k along bedding.
  [[nodiscard]] double anisotropy() const {
    return std::isnan(conductivity_across) ? 1.0 : conductivity_across / conductivity;
  }
  /// n_L,max = 1 - n_C.
  [[nodiscard]] double porosity_max() const { return 1.0 - skeleton_fraction; }
  [[nodiscard]] ErosionModel erosion_model() const {
    return {.law = erosion.law,
            .rate = erosion.rate,
            .start = erosion.start,
            .porosity_max = porosity_max(),
            .drive = erosion.law->drive.empty() ? erosion.drive : drive_law(erosion.law->drive),
            .threshold = erosion.threshold,
            .residual = erosion.residual,
            .critical_concentration = erosion.critical_concentration,
            .length = erosion.length};
  }
  [[nodiscard]] ConductivityModel conductivity_model() const {
    return {conductivity_law, conductivity, skeleton_fraction, conductivity_parameters};
  }
  [[nodiscard]] ExchangeModel exchange_model(const LiquidProperties& liquid) const {
    return {.erosion = erosion_model(),
            .deposition = deposition,
            .conductivity = conductivity_model(),
            .ergun = drag == SoilDrag::ergun,
            .water_density = liquid.density,
            .water_viscosity = liquid.viscosity,
            .viscosity = liquid.viscosity_model};
  }
  /// Gradient along a Darcy flux over |q|/k: 1, or more where the flux crosses the bedding. `flux`
  /// has 2 or 3 components.
  template <class Flux>
  [[nodiscard]] double resistance_along(const Flux& flux) const {
    const double squared = flux.squaredNorm();
    if (anisotropy() == 1.0 || squared == 0.0) return 1.0;
    const double angle = bedding * std::numbers::pi / 180.0;
    const double across = std::cos(angle) * flux[flux.size() - 1] - std::sin(angle) * flux[0];
    return 1.0 + (1.0 / anisotropy() - 1.0) * across * across / squared;
  }
  /// Whether fines can erode or be deposited in this soil.
  [[nodiscard]] bool exchanges() const { return erodes(erosion_model()) || deposition.deposits(); }
  /// n_0 at a position of 2 or 3 coordinates.
  template <class Position>
  [[nodiscard]] double initial_porosity(const Position& x) const {
    double n = porosity;
    for (int d = 0; d < static_cast<int>(x.size()); ++d) {
      n += porosity_gradient[d] * (x[d] - porosity_origin[d]);
    }
    return n;
  }
};

/// The conditions on one named boundary, or at one well: at most one for the flow, and those that
/// fix or load the soil there.
struct BoundaryCondition {
  std::string key;  ///< its entry in the scene: `boundary[0]`, `well[0]`
  std::string on;
  std::optional<TimeFunction> pressure;  ///< Pa
  std::optional<TimeFunction>
      velocity;  ///< intrinsic liquid velocity, positive into the model, m/s
  std::optional<TimeFunction> darcy_flux;  ///< volume flux, positive into the model, m/s
  /// m above the datum; without gravity the excess head.
  std::optional<TimeFunction> head;
  /// Area of the water table of a reservoir outside, m2 (per m of thickness in 2D): `head` is its
  /// level at the start, which then follows from what crosses the boundary. Not a number: the water
  /// outside has no end.
  double reservoir_area = unset;
  DryPart dry = DryPart::seepage;
  bool seepage_face = false;  ///< air outside: water leaves at p = 0, none enters
  /// Volume flux of rain, m/s; the flux that enters is limited to that at p = 0.
  std::optional<TimeFunction> rain;
  /// Rate of a well: volume of liquid that enters through all its faces per second, m3/s per m, in
  /// three dimensions m3/s.
  std::optional<TimeFunction> rate;
  std::optional<TimeFunction> concentration;  ///< c of the liquid that enters
  Fixing fix = Fixing::none;
  /// Force per area on the soil and the liquid in its pores, Pa, in the directions of the axes.
  std::optional<VectorFunction> traction;

  [[nodiscard]] bool is_reservoir() const { return !std::isnan(reservoir_area); }
  [[nodiscard]] bool is_well() const { return key.starts_with("well"); }
  /// Whether it says nothing of the liquid, which then does not cross it.
  [[nodiscard]] bool is_impervious() const {
    return !pressure && !velocity && !darcy_flux && !head && !rain && !rate && !seepage_face;
  }
};

/// A wall without thickness on a named curve inside the mesh.
struct Wall {
  std::string on;
  double conductance = 0.0;  ///< flux per difference of head across it, 1/s
};

/// A line along which the discharge is recorded.
struct OutputSection {
  std::array<double, 3> from{};  ///< m
  std::array<double, 3> to{};    ///< m
};

struct OutputProbe {
  std::array<double, 3> at{};       ///< m
  std::optional<double> disc = {};  ///< radius of the disc over which means are formed, m
};

struct TimeSettings {
  double end = unset;  ///< s
  FlowScheme scheme = FlowScheme::implicit_mixed;
  /// Time step, s. Unset: 0.9 of the stability limit (explicit), or by `tolerance` (implicit).
  std::optional<double> step;
  double mass_scaling = 1.0;                              ///< S; explicit only
  DragIntegration drag = DragIntegration::explicit_drag;  ///< explicit only
  TimeStepping stepping = TimeStepping::second_order;     ///< implicit only
  TransportScheme transport = TransportScheme::by_count;  ///< single-point only
  std::optional<bool> inertia;  ///< implicit only; unset: decided from the scene
  double tolerance = 1e-3;      ///< implicit only: bound of the relative local error of a step
  AtFailure failure = AtFailure::by_room;  ///< for skeletons that move
};

struct FlowSettings {
  /// false: Eq. 2 lacks (v_L - v_S) . grad n_L as in standard single-point codes, and water is lost
  /// wherever porosity varies. For comparison only.
  bool porosity_gradient_term = true;
  /// Double-point: where pressures are stored. Mixed: one per element. Material-point: at liquid
  /// points, which then carry velocity too, as in the paper.
  PressureIntegration integration = PressureIntegration::mixed;
};

/// How fields are stored in snapshots.
enum class FieldPrecision { float64, float32 };

struct OutputSettings {
  double every = unset;           ///< s between rows of the tables and, by default, snapshots
  double snapshot_every = unset;  ///< s between snapshots
  /// s between rows and between snapshots while soil fails; unset: as at other times.
  std::optional<double> failure_every;
  int restarts = 2;  ///< number of newest snapshots from which a run can be continued
  FieldPrecision precision = FieldPrecision::float64;
  std::vector<OutputProbe> probes;
  std::vector<OutputSection> sections;
};

struct Scene {
  std::string name;
  Formulation formulation = Formulation::single_point;
  GeometrySettings geometry;
  MeshSettings mesh;
  PointSettings points;
  LiquidProperties liquid;
  std::vector<Soil> soils;
  std::set<std::string> free_regions;         ///< regions that the scene makes free
  std::vector<BoundaryCondition> boundaries;  ///< boundaries, then wells
  std::vector<Wall> walls;
  std::array<double, 3> gravity{};  ///< m/s2
  InitialFlow initial_flow = InitialFlow::rest;
  std::string initial_from;  ///< results folder whose last state is the initial one; may be empty
  /// Time over which regions are dug out or filled in at the start, s; unset: 1 % of
  /// `time.end`.
  double construction = unset;
  /// Level of the liquid at rest, m above the datum: given, or the head of the boundaries at t = 0.
  std::optional<double> water_level;
  /// K_0: horizontal over vertical effective stress at the start; unset: equilibrium under gravity.
  std::optional<double> earth_pressure;
  FlowSettings flow;
  TimeSettings time;
  OutputSettings output;
  CheckSettings check;

  /// See `construction`, s.
  [[nodiscard]] double construction_time() const {
    return std::isnan(construction) ? 0.01 * time.end : construction;
  }
  /// Whether some soil has a skeleton that moves.
  [[nodiscard]] bool moves() const;
  [[nodiscard]] const Soil* find_soil(const std::string& region) const;
  /// Names of the walls and wells inside the mesh. They do not move; soil slides along them.
  [[nodiscard]] std::vector<std::string> names_of_slits() const;
  /// Free water (n_L = 1, no solid): a region without a soil that the scene makes free or that is
  /// called inflow, outflow, free_above or free_below, in a double-point scene or one whose soil
  /// moves.
  [[nodiscard]] bool is_free_water(const std::string& region) const;
  /// Whether the run follows the failure of soil in a mesh with these regions.
  [[nodiscard]] bool follows_failure(const std::vector<std::string>& regions) const;
};

/// Whether a region of this name holds free water if it has no soil: inflow, outflow, free_above
/// and free_below.
bool names_free_water(const std::string& region);

/// A scene with the text it came from, so that the next stage can check and report against it
/// again.
struct SceneDocument {
  std::string path;                    ///< as the user gave it
  std::string folder;                  ///< of the scene when it was read from a file, absolute
  std::string text;                    ///< the TOML file, byte for byte
  std::vector<std::string> overrides;  ///< `--set` arguments, in order
  Scene scene;
  /// `FILE:LINE` (or `--set KEY=VALUE`) of every given key, by dotted key; entries of [[boundary]]
  /// are `boundary[0].on` and so on. Tables are included under their own names.
  std::map<std::string, std::string> where;
  /// Text of each table that a boundary takes from a file, by the file's name in the scene: the
  /// next stage reads the same numbers on any machine.
  std::map<std::string, std::string> files;
  std::set<std::string> plane_vectors;  ///< keys of vectors that are given with two numbers

  /// Place where `key` was given; otherwise that of the nearest enclosing table, or the file's
  /// name.
  [[nodiscard]] std::string locate(const std::string& key) const;
};

/// Reads and checks a scene. Throws FileError when the file cannot be read, InputError with every
/// problem found otherwise.
SceneDocument read_scene(const std::string& path, const std::vector<std::string>& overrides = {});

/// Reads and checks a scene whose text and files are already in memory; `path` is used in messages
/// only.
SceneDocument parse_scene(const std::string& text, const std::string& path,
                          const std::vector<std::string>& overrides = {},
                          const std::map<std::string, std::string>& files = {});

/// Sets the defaults that depend on the dimension of the mesh, which is unknown in a scene with a
/// geometry file.
void complete_for_mesh(SceneDocument& document, int dimension);

/// Path of a file that a scene names relative to its own folder.
std::string file_beside_scene(const std::string& scene, const std::string& name);

/// docs/reference/scene-reference.md, generated from the schema.
std::string scene_reference_markdown();

}  // namespace suffuse
