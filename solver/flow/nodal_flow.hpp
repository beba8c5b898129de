#pragma once

/// The explicit flow of a scene (`scheme = "explicit"`): the nodal scheme with its step, checked
/// against the stability limit as the run goes.

#include <vector>

#include "flow/explicit_nodal.hpp"
#include "flow/scene_flow.hpp"
#include "flow/stability_limit.hpp"

namespace suffuse {

template <int Dim>
class NodalFlow final : public SceneFlow<Dim> {
 public:
  NodalFlow(const Case<Dim>& c, const Grid<Dim>& grid, const RigidSkeleton<Dim>& skeleton,
            const FlowOptions& options);

  [[nodiscard]] ExplicitNodal<Dim>& scheme() { return scheme_; }

  void update(double time, const PoreContent& content,
              const std::vector<double>& face_concentration) override;
  void start() override;
  /// Steps of one length, as many as the interval allows. Shortens the step when the stability
  /// limit falls below it, or throws NumericalError when the scene gave it.
  FlowProgress<Dim> run(const FlowInterval<Dim>& interval) override;

  [[nodiscard]] const std::vector<double>& pressure() const override { return scheme_.pressure(); }
  void follow_masses(double time, const std::vector<double>& water_mass) override;

  [[nodiscard]] FlowMoment<Dim> moment(double time) const override;
  [[nodiscard]] std::vector<PassTiming> passes() const override { return {timing_}; }

  /// Stability limit with the coefficients and speeds of this moment: element by element, and in
  /// double-point scenes, where `step` is above that, of the assembled scheme.
  [[nodiscard]] StabilityLimit current_limit(double step) const;

 private:
  void check_step(double time);
  /// One step of the scheme under the boundary values of its time.
  void step(double begin, double dt);
  [[nodiscard]] FlowMoment<Dim> moment_of(double time, std::vector<double> pressure,
                                          VectorField<Dim> velocity) const;
  [[nodiscard]] Passed<Dim> passed() const;
  void warn_of_locking(const VectorField<Dim>& steady_velocity);

  NodalOperator<Dim> operator_;
  ExplicitNodal<Dim> scheme_;
  double step_;
  bool step_given_;
  PassTiming timing_{"flow", 0, 0.0};
  /// The two limits when the assembled one was last found; it follows the other until that has
  /// moved.
  mutable double assembled_limit_ = unset;
  mutable double element_limit_ = unset;
};

}  // namespace suffuse
