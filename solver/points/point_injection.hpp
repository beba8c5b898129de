#pragma once

/// Liquid points that enter the model: at a face with inflow a point is injected whenever its
/// volume has flowed in.

#include <vector>

#include "boundary/face_conditions.hpp"
#include "mixed/flow.hpp"
#include "points/liquid_points.hpp"

namespace suffuse {

/// Difference of flowed volumes and whole points at the outer boundary.
struct InflowAccount {
  /// Per face: inflow minus injected points plus points that left, m3. When it reaches the volume
  /// of a point and the flow is inward, a point is injected.
  std::vector<double> volume;
  std::vector<long> injected;  ///< points so far, per face
  long next_id = 0;

  void archive(auto& archive) { archive(on_faces(volume), on_faces(injected), next_id); }
};

/// A point that enters the model.
template <int Dim>
struct InjectedPoint {
  PointPlace<Dim> place;
  int face;
  long number;   ///< among the points of its face
  double share;  ///< of the step before its entry
};

/// Size of injected points, and their distribution in the inflow.
struct InjectionSettings {
  std::vector<double> point_volume;  ///< per face: liquid volume of one point, m3
  /// Per face: number of points that fill the element behind it.
  std::vector<int> points_per_element;
  /// Whether points come at random times in the inflow of an element's volume, or evenly.
  bool random = false;
  int seed = 1;
};

/// Settings for points of the size of those in the element behind each face at the start,
/// distributed as the scene's `points.seeding` says.
template <int Dim>
InjectionSettings injection_settings(const Case<Dim>& c, const Grid<Dim>& grid);

template <int Dim>
class PointInjection {
 public:
  PointInjection(const Grid<Dim>& grid, const std::vector<FaceCondition>& conditions,
                 InjectionSettings settings, LiquidDensities densities, double bulk_modulus);

  /// The account at the start. Its volumes differ from face to face, so that faces inject in turn.
  [[nodiscard]] InflowAccount initial_account(long next_id) const;

  /// Own outer faces that are not impervious, ascending; points cross them.
  [[nodiscard]] const std::vector<int>& open_faces() const { return open_faces_; }
  /// Whether each face is open.
  [[nodiscard]] const std::vector<unsigned char>& is_open() const { return is_open_; }

  /// Appends to `points` each point whose volume has flowed in completely during a step, in the
  /// order of completion. `volume`: of liquid per face in the step, along its normal, m3.
  /// `node_flux`: their distribution along a face, m/s; empty: even. Throws NumericalError if a
  /// face would take an unreasonable number of points.
  void inject(InflowAccount& account, const std::vector<double>& volume,
              const VectorField<Dim>& node_flux, std::vector<InjectedPoint<Dim>>& points) const;

  /// The place of each of these points among those of all ranks in the order of completion, and
  /// their number. All ranks have to call it.
  struct Places {
    std::vector<long> of_point;
    long count;
  };
  [[nodiscard]] Places places(const std::vector<InjectedPoint<Dim>>& points) const;

  /// Masses of an injected point, from the concentration of its boundary and the density of water
  /// at the pressure of its element, Pa.
  struct Content {
    double water_mass;  ///< kg
    double fines_mass;  ///< kg
  };
  [[nodiscard]] Content content(const InjectedPoint<Dim>& point, double element_pressure) const;

 private:
  /// Number of point volumes that must have flowed in through a face for its point `number`.
  [[nodiscard]] double volumes_at_injection(int face, long number) const;
  [[nodiscard]] PointPlace<Dim> place_on_face(int face, long number,
                                              const VectorField<Dim>& node_flux) const;

  const Grid<Dim>& grid_;
  const std::vector<FaceCondition>& conditions_;
  InjectionSettings settings_;
  std::vector<unsigned char> is_open_;
  std::vector<int> open_faces_;
  LiquidDensities densities_;
  double bulk_modulus_;
};

}  // namespace suffuse
