#pragma once

/// The solid phase as an interface for the rest of the solver: soil at material points, of which a
/// part can erode into the liquid. The skeleton that stays in place is `RigidSkeleton`, the one
/// that moves is `MovingSkeleton` (motion/).

#include <vector>

#include "common/errors.hpp"
#include "grid/grid.hpp"
#include "results/state_archive.hpp"
#include "results/writer.hpp"
#include "solid/point_flows.hpp"

namespace suffuse {

/// What the solid points hold, m3. Porosity follows from this and the volume that a point stands
/// for.
struct SolidState {
  std::vector<double> skeleton_volume;   ///< per point: coarse grains, which never erode
  std::vector<double> erodible_volume;   ///< per point: fines that can erode, deposits among them
  std::vector<double> deposited_volume;  ///< per point: deposited since the start

  [[nodiscard]] double solid_volume(int point) const {
    return skeleton_volume[point] + erodible_volume[point];
  }
  void archive(auto& archive) { archive(skeleton_volume, erodible_volume, deposited_volume); }
};

/// The soil cannot carry what loads it any longer, or is about to fail. Thrown before a step
/// changes anything: the model is as it was in the last equilibrium.
class EquilibriumLost : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// How far soil fills an element at its surface.
struct SoilFilling {
  void archive(auto& archive) { archive(share, porosity); }

  double share = 1.0;     ///< of the element; 0: free water
  double porosity = 0.0;  ///< n_L of the soil there; not used where the share is 0 or 1
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
  /// Volume that a point has given to the liquid since the start, per volume of its soil today;
  /// what was deposited there counts as given back.
  [[nodiscard]] virtual double eroded_share(int point) const = 0;
  /// Mean n_L per element.
  [[nodiscard]] virtual std::vector<double> element_porosity() const = 0;

  /// Whether fines can be exchanged with the liquid between two times.
  [[nodiscard]] virtual bool exchanges_within(double from, double to) const = 0;
  /// n_L per solid point at time `to`, from now (`from`), without changing the state.
  [[nodiscard]] virtual std::vector<double> porosity_after(double from, double to,
                                                           const PointFlows& flows) const = 0;
  /// Exchanges fines with the liquid from `from` to `to`. `exchange` becomes the volume per solid
  /// point that went into the liquid, m3 (negative: that came from it). Elements of `excluded` (per
  /// element, may be empty) stay as they are.
  virtual void exchange(double from, double to, const PointFlows& flows,
                        const std::vector<char>& excluded, std::vector<double>& exchange) = 0;
  /// What a solid point exchanges from now (`from`) to `to` with liquid of concentration
  /// `concentration`, which flows on, if its porosity is `porosity` at `from`.
  [[nodiscard]] virtual Exchange exchange_at(int point, double porosity, double concentration,
                                             double from, double to,
                                             const PointFlows& flows) const = 0;
  /// How fast it does at a time, per volume of soil and second.
  [[nodiscard]] virtual Exchange exchange_rate_at(int point, double porosity, double concentration,
                                                  double time, const PointFlows& flows) const = 0;
  /// Whether a point can have such a porosity at a time: no more has eroded than can, nor is more
  /// filled.
  [[nodiscard]] virtual bool is_possible(int point, double porosity, double time,
                                         const PointFlows& flows) const = 0;
  /// The state after such an exchange at each point; `exchange` as above.
  virtual void apply(const std::vector<Exchange>& change, std::vector<double>& exchange) = 0;
  /// Takes what the liquid has left, m3 per solid point; empty: nothing.
  virtual void deposit(const std::vector<double>& volume) = 0;

  /// Starts with what the points of another run hold, in the same places.
  virtual void start_from(const SolidState& state) = 0;

  virtual void archive(StateArchive& archive) = 0;

  // What others see of a motion.

  [[nodiscard]] virtual bool moves() const { return false; }
  /// Whether it has lost its equilibrium and moves with its inertia.
  [[nodiscard]] virtual bool has_inertia() const { return false; }
  /// Times at which what loads the solid has a kink, s.
  [[nodiscard]] virtual std::vector<double> load_breakpoints() const { return {}; }
  /// Solid that points have carried into each region of the mesh since the start, minus what they
  /// have carried out of it, m3. Empty while the solid stays in place.
  [[nodiscard]] virtual std::vector<double> region_gain() const { return {}; }
  /// Per element; empty while soil fills all elements that it filled at the start.
  [[nodiscard]] virtual const std::vector<SoilFilling>& filling() const {
    static const std::vector<SoilFilling> all;
    return all;
  }
  /// Adds what is known of the motion to a row and to a snapshot, whose fields of solid points are
  /// in the order of `soils().points()`.
  virtual void describe(HistoryRow& /*row*/) const {}
  virtual void describe(Snapshot& /*snapshot*/) const {}
};

}  // namespace suffuse
