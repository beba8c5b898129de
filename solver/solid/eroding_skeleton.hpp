#pragma once

/// What skeletons share whose points erode and catch fines, whether they move or not.

#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
class ErodingSkeleton : public Skeleton<Dim> {
 public:
  ErodingSkeleton(const Grid<Dim>& grid, const SoilMap<Dim>& soils, const TimeSpan& span,
                  int threads);

  [[nodiscard]] const SoilMap<Dim>& soils() const override { return soils_; }
  [[nodiscard]] const SolidState& state() const override { return state_; }
  [[nodiscard]] const std::vector<double>& porosity() const override { return porosity_; }
  [[nodiscard]] const std::vector<double>& initial_porosity() const override {
    return initial_porosity_;
  }
  [[nodiscard]] double eroded_share(int point) const override {
    return porosity_[point] - initial_porosity_[point];
  }

  [[nodiscard]] bool exchanges_within(double from, double to) const override {
    return span_.meets(from, to);
  }
  [[nodiscard]] std::vector<double> porosity_after(double from, double to,
                                                   const PointFlows& flows) const override;
  void exchange(double from, double to, const PointFlows& flows, const std::vector<char>& excluded,
                std::vector<double>& exchange) override;
  [[nodiscard]] Exchange exchange_at(int point, double porosity, double concentration, double from,
                                     double to, const PointFlows& flows) const override;
  [[nodiscard]] Exchange exchange_rate_at(int point, double porosity, double concentration,
                                          double time, const PointFlows& flows) const override;
  [[nodiscard]] bool is_possible(int point, double porosity, double time,
                                 const PointFlows& flows) const override;
  void apply(const std::vector<Exchange>& change, std::vector<double>& exchange) override;
  void deposit(const std::vector<double>& volume) override;

  void start_from(const SolidState& state) override;
  void archive(StateArchive& archive) override;

 protected:
  /// Porosity of all points from what they hold and the volumes that they stand for.
  void update_porosity();

  const Grid<Dim>& grid_;
  int threads_;
  SolidState state_;
  std::vector<double> initial_porosity_;
  std::vector<double> porosity_;
  /// Per point: porosity once all fines are gone, today. It changes as the soil is compressed.
  /// Empty while soils stay in place: theirs.
  std::vector<double> porosity_max_;

 private:
  /// n_L of a point from what it holds.
  [[nodiscard]] double porosity_of(int point) const {
    return 1.0 - state_.solid_volume(point) / soils_.points().volume[point];
  }
  /// The law of a point with its numbers of today. `changed` is where they are kept if they differ
  /// from those of its soil.
  const ExchangeModel& model_of(int point, ExchangeModel& changed) const;
  /// Changes the state of a point; returns the volume that went into the liquid, m3.
  double take(int point, const Exchange& change);
  /// Throws NumericalError where deposits leave hardly any pores.
  void refuse_full() const;
  /// What erodes where nothing but the flux drives it: in closed form, without the rest of what
  /// exchange may depend on.
  static Exchange eroded_at(const ErosionModel& erosion, int point, double porosity, double from,
                            double to, const PointFlows& flows);
  /// Calls `take(point, exchange)` for every point of an element whose soil exchanges fines.
  template <class Take>
  void exchange_in(int element, double from, double to, const PointFlows& flows,
                   const Take& take) const;

  const SoilMap<Dim>& soils_;
  TimeSpan span_;
};

}  // namespace suffuse
