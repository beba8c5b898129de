#include "physics/erosion/erosion_law.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace suffuse {
namespace {

LocalState local_state(const ErosionModel& model, double porosity, double flux) {
  return {.porosity = porosity,
          .erodible_fraction = erodible_fraction(model, porosity, flux),
          .flux = flux};
}

/// D if it depends at most on |q|; otherwise NaN.
double drive_at(const ErosionModel& model, double flux) {
  return model.drive->depends_on_flow() ? model.drive->value({.flux = flux}) : 1.0;
}

/// Limits the porosity after a step exactly to the range from its value before to that of fully
/// eroded soil. NaN stays NaN.
double bounded(double porosity, const ErosionModel& model, const LocalState& before) {
  const double most = model.porosity_max - model.residual.at(before.flux);
  return std::max(std::min(porosity, most), before.porosity);
}

/// Whether erosion depends only on time and the state of the solid, which gives a closed form.
bool depends_on_time_alone(const ErosionModel& model) {
  return !depends_on_flux(model) && !depends_on_concentration(model);
}

}  // namespace

double ResidualFraction::at(double flux) const {
  if (pairs.empty()) return 0.0;
  if (pairs.size() == 1) return pairs.front().second;
  if (std::isnan(flux)) return unset;
  const auto after =
      std::ranges::upper_bound(pairs, flux, {}, [](auto& pair) { return pair.first; });
  if (after == pairs.begin()) return pairs.front().second;
  if (after == pairs.end()) return pairs.back().second;
  const auto before = after - 1;
  return std::lerp(before->second, after->second,
                   (flux - before->first) / (after->first - before->first));
}

const ErosionLaw* no_erosion() {
  return erosion_laws().front();
}

const ErosionLaw* erosion_law(std::string_view word) {
  for (const ErosionLaw* law : erosion_laws()) {
    if (law->word == word) return law;
  }
  throw std::invalid_argument("no erosion law '" + std::string(word) + "'");
}

std::string law_text(const ErosionModel& model, const std::string& rate) {
  std::string text(model.law->word);
  text += " law, ";
  const bool named = model.drive->depends_on_flow() && model.law->drive.empty();
  if (named) text += std::string(model.drive->word) + ", ";
  return text + rate + " " + std::string(model.drive->rate_unit);
}

bool erodes(const ErosionModel& model) {
  return model.law != nullptr && model.law->erodes() && model.rate > 0.0;
}

bool depends_on_flux(const ErosionModel& model) {
  return erodes(model) && (model.drive->depends_on_flow() || model.residual.depends_on_flux());
}

bool depends_on_concentration(const ErosionModel& model) {
  return erodes(model) &&
         (model.law->depends_on_concentration || std::isfinite(model.critical_concentration));
}

double erodible_fraction(const ErosionModel& model, double porosity, double flux) {
  return std::max(model.porosity_max - porosity - model.residual.at(flux), 0.0);
}

double drive_rate(const ErosionModel& model, double drive) {
  return model.rate *
         std::max(drive - (model.drive->depends_on_flow() ? model.threshold : 0.0), 0.0);
}

double scaled_time(const ErosionModel& model, double from, double to, double drive_from,
                   double drive_to) {
  const double begin = std::max(from, model.start);
  if (to <= begin || !erodes(model)) return 0.0;
  const double late = begin == from || drive_from == drive_to
                          ? drive_from
                          : std::lerp(drive_from, drive_to, (begin - from) / (to - from));
  const double first = drive_rate(model, late);
  const double last = drive_rate(model, drive_to);
  double mean = 0.5 * (first + last);
  if (model.drive->depends_on_flow() && (first == 0.0) != (last == 0.0)) {
    // The rate is a triangle over the time in which the drive is above its threshold.
    const double above = std::max(late, drive_to) - model.threshold;
    mean *= above / std::abs(drive_to - late);
  }
  return mean * (to - begin);
}

double porosity_after_scaled(const ErosionModel& model, double porosity, double scaled_time,
                             double flux) {
  const LocalState state = local_state(model, porosity, flux);
  if (scaled_time == 0.0 || state.erodible_fraction == 0.0 || !erodes(model)) return porosity;
  if (std::isinf(scaled_time)) return bounded(1.0, model, state);
  if (model.law->porosity_after == nullptr) return unset;
  return bounded(model.law->porosity_after(state, scaled_time), model, state);
}

double erosion_rate(const ErosionModel& model, double porosity, double time, double flux) {
  if (time < model.start || !erodes(model)) return 0.0;
  const LocalState state = local_state(model, porosity, flux);
  if (state.erodible_fraction == 0.0) return 0.0;
  return drive_rate(model, drive_at(model, flux)) * model.law->state(state);
}

double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                      double flux_from, double flux_to) {
  if (!erodes(model) || porosity >= model.porosity_max) return porosity;
  const double first = drive_at(model, flux_from);
  const double last = flux_from == flux_to ? first : drive_at(model, flux_to);
  return porosity_after_scaled(model, porosity, scaled_time(model, from, to, first, last),
                               0.5 * (flux_from + flux_to));
}

double exact_porosity(const ErosionModel& model, double initial_porosity, double time,
                      double flux) {
  if (time <= model.start || initial_porosity >= model.porosity_max || !erodes(model)) {
    return initial_porosity;
  }
  const auto exact =
      model.law->exact_porosity ? model.law->exact_porosity : model.law->porosity_after;
  if (exact == nullptr || depends_on_concentration(model)) return unset;
  const LocalState state = local_state(model, initial_porosity, flux);
  if (state.erodible_fraction == 0.0) return initial_porosity;
  const double drive = drive_at(model, flux);
  return bounded(exact(state, scaled_time(model, model.start, time, drive, drive)), model, state);
}

bool has_exact_porosity(const ErosionModel& model) {
  return !erodes(model) || depends_on_time_alone(model);
}

double exhaustion_time(const ErosionModel& model, double initial_porosity) {
  constexpr double never = std::numeric_limits<double>::infinity();
  if (initial_porosity >= model.porosity_max) return model.start;
  if (!erodes(model) || !depends_on_time_alone(model) || model.law->exhaustion == nullptr) {
    return never;
  }
  const LocalState state = local_state(model, initial_porosity, unset);
  if (state.erodible_fraction == 0.0) return model.start;
  return model.start + model.law->exhaustion(state) / model.rate;
}

std::vector<double> breakpoints(const ErosionModel& model, double initial_porosity) {
  if (!erodes(model)) return {};
  std::vector<double> times{model.start};
  const double end = exhaustion_time(model, initial_porosity);
  if (end > model.start && std::isfinite(end)) times.push_back(end);
  return times;
}

}  // namespace suffuse
