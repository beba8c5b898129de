#pragma once

/// Erosion and deposition at points, common to rigid and moving skeletons.

#include <memory>

#include "solid/nonlocal_flux.hpp"
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

  void find_eroding_flux(PointFlows& flows) const override;
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
  /// Updates the porosity of all points from their solid and total volumes.
  void update_porosity();

  const Grid<Dim>& grid_;
  int threads_;
  SolidState state_;
  std::vector<double> initial_porosity_;
  std::vector<double> porosity_;
  /// Per point: present porosity without fines, which changes as soil is compressed. Empty if soil
  /// does not move: that of the soil holds then.
  std::vector<double> porosity_max_;

 private:
  /// n_L of a point by its solid volume.
  [[nodiscard]] double porosity_of(int point) const {
    return 1.0 - state_.solid_volume(point) / soils_.points().volume[point];
  }
  /// Share of the fines at the start that each point has, if its porosity becomes this from now on.
  [[nodiscard]] std::vector<double> fines_left_at(const std::vector<double>& porosity) const;
  /// The law of a point with its present parameters; `changed` stores them if they differ from
  /// those of its soil.
  const ExchangeModel& model_of(int point, ExchangeModel& changed) const;
  /// The solid at a point, if its porosity becomes this.
  [[nodiscard]] SoilPlace place_of(int point, double porosity) const {
    const int e = soils_.points().element[point];
    return {initial_porosity_[point], porosity, soils_.conductivity_factor(e)};
  }
  /// Changes the state of a point; returns the volume that went into the liquid, m3.
  double take(int point, const Exchange& change);
  /// Throws NumericalError if deposits leave hardly any pores.
  void refuse_full() const;
  /// Erosion that depends on the flux at most, in closed form: the other data of the flow are not
  /// needed.
  static Exchange eroded_at(const ErosionModel& erosion, int point, double porosity, double from,
                            double to, const PointFlows& flows);
  /// Calls `take(point, exchange)` for every point of an element whose soil exchanges fines.
  template <class Take>
  void exchange_in(int element, double from, double to, const PointFlows& flows,
                   const Take& take) const;

  const SoilMap<Dim>& soils_;
  TimeSpan span_;
  std::unique_ptr<NonlocalFlux<Dim>> nonlocal_flux_;  ///< null: no soil has an `erosion.length`
};

}  // namespace suffuse
