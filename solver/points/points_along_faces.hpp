#pragma once

/// Liquid points that follow the volumes through faces (double-point default): exactly along the
/// flux of each element, from face to face, taking up fines along the path.

#include "grid/face_walk.hpp"
#include "points/point_transport.hpp"

namespace suffuse {

template <int Dim>
class PointsAlongFaces final : public PointTransport<Dim> {
 public:
  /// Starts with points of clean water at `places`, at the pressure of their elements, Pa.
  PointsAlongFaces(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                   const std::vector<FaceCondition>& conditions, InjectionSettings injection,
                   LiquidDensities densities, double bulk_modulus, int threads,
                   const MaterialPoints<Dim>& places, const std::vector<double>& pressure);

  [[nodiscard]] double longest_step(const std::vector<double>& face_rate) const override;

  [[nodiscard]] const LiquidPoints<Dim>& points() const override { return points_; }
  [[nodiscard]] long size() const override { return all_points_; }
  [[nodiscard]] LiquidContent content() const override;
  [[nodiscard]] std::vector<double> point_pressure(const LiquidPoints<Dim>& points,
                                                   const FlowState<Dim>& flow) const override;
  [[nodiscard]] std::vector<double> point_volume(
      const LiquidPoints<Dim>& points, const std::vector<double>& pressure) const override;

  void archive(StateArchive& archive) override;
  [[nodiscard]] std::vector<PassTiming> passes() const override {
    return {this->fines_timing_, this->movement_timing_};
  }

 private:
  void start_interval(const FlowProgress& flow) override;
  [[nodiscard]] double steps_needed(double start, const FlowProgress& flow) const override {
    // These volumes are those of the whole interval, so the step is a share of it.
    const double allowed = longest_step(flow.volumes.liquid);
    return step_count(allowed, start, flow.end, {1e4, "the flow has run away"});
  }
  void advance(const TransportStep& step, const FaceVolumes& volumes,
               const std::vector<double>& eroded, const std::vector<double>& pressure) override;
  void follow_deposits() override;
  void take_points(LiquidPoints<Dim> points, const FlowState<Dim>& /*flow*/) override {
    points.pressure.clear();
    points.velocity.clear();
    points_ = std::move(points);
    note_points();
  }
  /// Call when points have come or gone.
  void note_points();
  /// Paths of points in a step. Points that left are included, in their last element; injected
  /// points are at the end.
  struct Paths {
    std::vector<int> from;        ///< region at the start of the step, -1: outside
    std::vector<int> entered_by;  ///< outer face, of the injected ones only
    std::vector<int> left_by;     ///< outer face, -1: none
    std::vector<double> fines;    ///< of each point before it took any up, kg
    std::vector<FinesUptake<Dim>> uptakes;
  };

  [[nodiscard]] bool has_points(int element) const override {
    return begins_[element + 1] > begins_[element];
  }
  /// Porosity at the end of a step over this share of the interval.
  [[nodiscard]] std::vector<double> porosity_after(double share, bool exchanges);
  void inject(const std::vector<double>& volume, const std::vector<double>& pressure, Paths& paths,
              std::vector<double>& start);
  /// Moves every point: injected points from their entry, and points that leave until their exit.
  [[nodiscard]] Paths follow(const std::vector<double>& volume,
                             const std::vector<double>& porosity_end,
                             const std::vector<double>& pressure);
  /// Moves one point; appends its uptakes.
  void follow_point(int p, double start, const FaceWalkField<Dim>& field, double pressure,
                    std::vector<FacePassage<Dim>>& passages, Paths& paths,
                    std::vector<FinesUptake<Dim>>& uptakes);
  /// Factor on the uptake of a point: its fines over the mean of the element's points if the
  /// erosion law depends on the concentration, otherwise 1.
  [[nodiscard]] double weight(int element, int p) const;
  /// Ratio of the masses of fines and water of the points in each element; empty if no exchange
  /// depends on it.
  [[nodiscard]] std::vector<double> mean_fines() const;
  /// Removes points that left, after the transfer of fines, and books changes of region. Fines
  /// taken up in the first region cross its border with the point; others are received in the last
  /// region. A point that leaves the model crosses into its last region first.
  void settle(const Paths& paths);
  /// Books the volumes of points that left the model at the faces they left by.
  void book_outflow(const Paths& paths);

  LiquidPoints<Dim> points_;
  std::vector<double> mean_fines_;  ///< at the start of the step
  std::vector<int> begins_;         ///< points of each element
  long all_points_ = 0;             ///< of all ranks
  std::vector<double> porosity_;    ///< per element, at the start of the step
  // Motion of the solid; empty if it is rigid.
  std::vector<double> opening_;         ///< change of porosity by motion in the interval
  std::vector<double> solid_porosity_;  ///< after its motion, before the exchange of the step
  std::vector<double> exchanged_;       ///< change of porosity by exchange in the step
};

}  // namespace suffuse
