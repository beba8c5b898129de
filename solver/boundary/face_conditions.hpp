#pragma once

/// The scene's boundary conditions, face by face: walls, prescribed pressures and prescribed
/// fluxes, with their values in time.

#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "grid/grid.hpp"

namespace suffuse {

enum class FaceKind : unsigned char {
  interior,
  wall,      ///< impervious
  pressure,  ///< value: Pa
  velocity,  ///< value: intrinsic liquid velocity into the model, m/s
  flux,      ///< value: Darcy flux into the model, m/s
  /// Air outside: p <= 0 and a Darcy flux of at most `value` (m/s, >= 0) into the model; at least
  /// one of the two is an equality. `value` = 0: a seepage face; otherwise rain.
  seepage,
};

struct FaceCondition {
  FaceKind kind = FaceKind::interior;
  double value = 0.0;
  double concentration = 0.0;  ///< c of liquid that enters; 0 by default
  int boundary = -1;           ///< index of the scene's boundary entry
  /// The kind may change during the run: an implicit flow has an unknown for the face.
  bool switches = false;

  /// Stores the values that may change; the rest follows from the scene.
  void archive(auto& archive) { archive(kind, value, concentration); }
  /// Whether the flux through the face is prescribed (zero at a wall).
  [[nodiscard]] bool fixes_flux() const {
    return kind == FaceKind::wall || kind == FaceKind::velocity || kind == FaceKind::flux;
  }
};

/// Data of a face on which its condition depends, in addition to the scene's boundary entry.
struct FaceSurroundings {
  double unit_weight = 0.0;  ///< pressure per head: rho_w |g|, with 9.81 m/s2 without gravity, N/m3
  bool gravity = false;
  double height = 0.0;     ///< z of the face's centre against gravity, m
  double wet_above = 0.0;  ///< the face is under water if the head exceeds this (`WaterLine`), m
  /// Darcy flux through the face per rate of the whole boundary, 1/m2: k/(sum of k A), where k is
  /// the conductivity at the start across the face. Layers share a well's rate as their discharges
  /// under one head in the well do (McDonald and Harbaugh, MODFLOW, USGS TWRI 6-A1, 1988).
  double share = 0.0;
};

/// The condition of each face of the grid, with its values at t = 0. Throws InputError when a
/// condition names no boundary of the mesh or two conditions share a face.
template <int Dim>
std::vector<FaceCondition> face_conditions(const Case<Dim>& c, const Grid<Dim>& grid);

/// Pressure of the liquid at rest at each face's center, Pa.
template <int Dim>
std::vector<double> pressure_at_rest(const Scene& scene, const Grid<Dim>& grid);

/// The level of a reservoir at the end of the last step. `BoundaryValues::stage_rates` gives the
/// levels within a step.
struct ReservoirLevel {
  static constexpr bool has_no_gaps = true;  ///< see StateArchive
  double time = 0.0;                         ///< end of the last step, s
  double level = 0.0;                        ///< at that time, m
  double rate = 0.0;                         ///< dH/dt of the last step, m/s
};

/// Times whose boundary values a stage of a step uses, s.
struct BoundaryTime {
  double end = 0.0;        ///< of heads and pressures: the end of the stage
  double of_fluxes = 0.0;  ///< of fluxes and rain
  std::size_t stage = 0;   ///< number of the stage

  /// Values of a stage that ends its share of the step after the start. One stage may have the mean
  /// flux of the step, so that the volume of a table enters; two stages do so with their own
  /// fluxes. (The error of linear flow in rigid soil would take a change of the mean for a jump.)
  static BoundaryTime of_stage(double start, double dt, const std::vector<double>& shares,
                               std::size_t stage, bool has_mean) {
    return {start + shares[stage] * dt, start + (has_mean ? 0.5 : shares[stage]) * dt, stage};
  }
};

/// Boundary conditions that change in time. The kind of a face changes when the level of a head
/// passes it; such faces have `switches`.
template <int Dim>
class BoundaryValues {
 public:
  /// Throws as `face_conditions` does.
  BoundaryValues(const Case<Dim>& c, const Grid<Dim>& grid);

  /// Per face of the grid, at a time in s.
  [[nodiscard]] std::vector<FaceCondition> at(double time) const;
  /// Sets `conditions`, from `at` or `face_conditions` of this case, to those at `time`. Changes
  /// only faces of boundaries whose values change in time.
  void update(double time, std::vector<FaceCondition>& conditions) const;
  /// Likewise, with levels of reservoirs that have risen since the last step at these rates, m/s, a
  /// rate per reservoir for each stage.
  void update(const BoundaryTime& time, const std::vector<double>& reservoir_rates,
              std::vector<FaceCondition>& conditions) const;
  /// Sets only the concentrations to those at `time`. Liquid that enters during an interval has the
  /// concentration at mid-interval, which is the mean of a linear concentration.
  void update_concentrations(double time, std::vector<FaceCondition>& conditions) const;

  /// Longest step from `time` in which no value changes by more than this share of its range, but
  /// for jumps, s.
  [[nodiscard]] double longest_step(double time, double share) const;

  /// How fast the level of each reservoir rose in the last step, m/s. The list of all reservoirs is
  /// repeated this number of times.
  [[nodiscard]] std::vector<double> reservoir_rates(std::size_t times = 1) const;
  /// How fast it rises where these volumes, m3, cross the faces along their normals in `dt` s.
  [[nodiscard]] std::vector<double> reservoir_rates(const std::vector<double>& face_volume,
                                                    double dt) const;
  /// Mean rates from the start of a step of `dt`, s, to the end of each of its one or two stages,
  /// m/s, stage by stage. With the rates r_1 and r_2 of the flow at their ends, levels rise by
  /// a dt r_1 and by dt ((1 - a) r_1 + a r_2), where a is the share of the first stage.
  /// \param face_volume  through each face in the step, m3
  /// \param face_flux    at the end of the step, m3/s
  [[nodiscard]] std::vector<double> stage_rates(const std::vector<double>& face_volume,
                                                const std::vector<double>& face_flux, double dt,
                                                const std::vector<double>& shares) const;
  /// Levels rise at these rates, m/s, until `end`, s.
  void raise_reservoirs(double end, const std::vector<double>& rates);
  /// Head outside an entry of the scene's boundaries that has one, m: of a reservoir its level.
  [[nodiscard]] double level(int boundary, double time) const;

  /// What may change: the scene restores the rest.
  void archive(auto& archive) { archive(reservoirs_); }

  /// Whether any value changes in time.
  [[nodiscard]] bool vary() const { return !varying_.empty(); }
  /// Times at which a value may have a kink, in (0, end), s: ascending, each once. Between them
  /// every value is linear in time, unless the level of a head passes a face.
  [[nodiscard]] const std::vector<double>& breakpoints() const { return breakpoints_; }

 private:
  struct Varying {
    BoundaryCondition boundary;
    int index = -1;  ///< of the scene's boundary entry
    std::vector<int> faces;
    std::vector<FaceSurroundings> around;  ///< of each of the faces
    int reservoir = -1;                    ///< -1: none
  };

  const Scene& scene_;
  const Grid<Dim>& grid_;
  std::vector<FaceCondition> initial_;
  std::vector<Varying> varying_;
  std::vector<ReservoirLevel> reservoirs_;
  std::vector<double> breakpoints_;
};

}  // namespace suffuse
