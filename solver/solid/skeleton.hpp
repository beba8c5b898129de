#pragma once

/// The solid phase as an interface for the rest of the solver: soil at material points, part of
/// which can erode into the liquid. `RigidSkeleton` does not move, `MovingSkeleton` (motion/) does.

#include <vector>

#include "common/errors.hpp"
#include "grid/grid.hpp"
#include "results/state_archive.hpp"
#include "results/writer.hpp"
#include "solid/point_flows.hpp"

namespace suffuse {

/// Volumes of the solid points, m3. Porosity follows from them and the total volume of a point.
struct SolidState {
  std::vector<double> skeleton_volume;   ///< per point: coarse grains, which never erode
  std::vector<double> erodible_volume;   ///< per point: fines that can erode, with deposits
  std::vector<double> deposited_volume;  ///< per point: deposited since the start

  [[nodiscard]] double solid_volume(int point) const {
    return skeleton_volume[point] + erodible_volume[point];
  }
  /// Volume of the solid of each point, m3.
  [[nodiscard]] std::vector<double> solid_volumes() const {
    std::vector<double> result = skeleton_volume;
    for (std::size_t p = 0; p < result.size(); ++p) result[p] += erodible_volume[p];
    return result;
  }
  void archive(auto& archive) {
    archive(on_points(skeleton_volume), on_points(erodible_volume), on_points(deposited_volume));
  }
};

/// The soil cannot carry its loads any longer, or is about to fail. Thrown before a step changes
/// anything: the model stays in the last equilibrium.
class EquilibriumLost : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// The part of an element that soil which moves fills.
struct SoilFilling {
  void archive(auto& archive) { archive(share, porosity, excess); }

  double share = 1.0;     ///< of the element; 0: free water
  double porosity = 0.0;  ///< n_L of the soil there; not used if the share is 0 or 1
  double excess = 0.0;    ///< n_L of the element's points less that of the element
};

template <int Dim>
class Skeleton {
 public:
  Skeleton() = default;
  virtual ~Skeleton() = default;
  Skeleton(const Skeleton&) = delete;
  Skeleton& operator=(const Skeleton&) = delete;

  [[nodiscard]] virtual const SoilMap<Dim>& soils() const = 0;
  [[nodiscard]] virtual const SolidState& state() const = 0;
  /// n_L per solid point.
  [[nodiscard]] virtual const std::vector<double>& porosity() const = 0;
  /// n_L per solid point at the start.
  [[nodiscard]] virtual const std::vector<double>& initial_porosity() const = 0;
  /// Fines of a point that could erode at the start, m3, for its present volume.
  [[nodiscard]] double erodible_at_start(int point) const {
    return soils().points().volume[point] *
           (soils().soil_of_point(point).porosity_max() - initial_porosity()[point]);
  }
  /// Volume that a point has given to the liquid since the start minus its deposits, per present
  /// volume of its soil.
  [[nodiscard]] virtual double eroded_share(int point) const = 0;
  /// Mean n_L per element.
  [[nodiscard]] virtual std::vector<double> element_porosity() const = 0;

  /// Sets the flux that erosion sees, where soil has an `erosion.length`: its mean over the
  /// interval of the flows that starts now, or its present value if they have no interval.
  virtual void find_eroding_flux(PointFlows& /*flows*/) const {}
  /// Whether fines can be exchanged with the liquid between two times.
  [[nodiscard]] virtual bool exchanges_within(double from, double to) const = 0;
  /// n_L per solid point at time `to`, s, from now (`from`); the state does not change.
  [[nodiscard]] virtual std::vector<double> porosity_after(double from, double to,
                                                           const PointFlows& flows) const = 0;
  /// Exchanges fines with the liquid from `from` to `to`. `exchange` becomes the volume per solid
  /// point that entered the liquid, m3 (negative: left it). Elements marked in `excluded` (per
  /// element, may be empty) do not change.
  virtual void exchange(double from, double to, const PointFlows& flows,
                        const std::vector<char>& excluded, std::vector<double>& exchange) = 0;
  /// Exchange of a solid point from now (`from`) to `to` with flowing liquid of this
  /// `concentration`, if its porosity is `porosity` at `from`.
  [[nodiscard]] virtual Exchange exchange_at(int point, double porosity, double concentration,
                                             double from, double to,
                                             const PointFlows& flows) const = 0;
  /// Rate of this exchange at a time, per volume of soil and second.
  [[nodiscard]] virtual Exchange exchange_rate_at(int point, double porosity, double concentration,
                                                  double time, const PointFlows& flows) const = 0;
  /// Whether a point can have this porosity at a time, by the limits of erosion and deposition.
  [[nodiscard]] virtual bool is_possible(int point, double porosity, double time,
                                         const PointFlows& flows) const = 0;
  /// Applies such an exchange at each point; `exchange` as above.
  virtual void apply(const std::vector<Exchange>& change, std::vector<double>& exchange) = 0;
  /// Adds fines that the liquid has left, m3 per solid point; empty: none.
  virtual void deposit(const std::vector<double>& volume) = 0;

  /// Takes the state of the points of another run, in the same places.
  virtual void start_from(const SolidState& state) = 0;

  virtual void archive(StateArchive& archive) = 0;

  // Motion, as others see it.

  [[nodiscard]] virtual bool moves() const { return false; }
  /// Whether the soil has lost its equilibrium and moves with inertia.
  [[nodiscard]] virtual bool has_inertia() const { return false; }
  /// Times of kinks in the loads on the solid, s.
  [[nodiscard]] virtual std::vector<double> load_breakpoints() const { return {}; }
  /// Solid that points carried into each region, less what they carried out, m3; empty at rest.
  [[nodiscard]] virtual std::vector<double> region_gain() const { return {}; }
  /// Per element; empty if soil fills all elements that it filled at the start.
  [[nodiscard]] virtual const std::vector<SoilFilling>& filling() const {
    static const std::vector<SoilFilling> all;
    return all;
  }
  /// Adds data of the motion to a row and to a snapshot, whose fields of solid points are in the
  /// order of `soils().points()`.
  virtual void describe(HistoryRow& /*row*/) const {}
  virtual void describe(Snapshot& /*snapshot*/) const {}
};

}  // namespace suffuse
