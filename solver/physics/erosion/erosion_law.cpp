#include "physics/erosion/erosion_law.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace suffuse {
namespace {

LocalState local_state(const ErosionModel& model, double porosity, double time, double flux) {
  return {.porosity = porosity,
          .erodible_fraction = model.porosity_max - porosity,
          .skeleton_fraction = 1.0 - model.porosity_max,
          .flux = flux,
          .time = time};
}

/// What a step leaves: not more than all eroded, and not less than before, to the last digit. Lets
/// pass what is not a number.
double bounded(double porosity, double before, double most) {
  return std::max(std::min(porosity, most), before);
}

}  // namespace

const ErosionLaw* no_erosion() {
  return erosion_laws().front();
}

const ErosionLaw* erosion_law(std::string_view word) {
  for (const ErosionLaw* law : erosion_laws()) {
    if (law->word == word) return law;
  }
  throw std::invalid_argument("no erosion law '" + std::string(word) + "'");
}

std::string law_text(const ErosionLaw& law, const std::string& rate) {
  return std::string(law.word) + " law, " + rate + " " + std::string(law.rate_unit);
}

bool erodes(const ErosionModel& model) {
  return model.law != nullptr && model.law->erodes() && model.rate > 0.0;
}

bool depends_on_flux(const ErosionModel& model) {
  return erodes(model) && model.law->depends_on_flux;
}

double erosion_rate(const ErosionModel& model, double porosity, double time, double flux) {
  if (time < model.start || porosity >= model.porosity_max || !erodes(model)) return 0.0;
  return model.law->erosion_rate(model, local_state(model, porosity, time, flux));
}

double porosity_after(const ErosionModel& model, double porosity, double from, double to,
                      double flux) {
  const double begin = std::max(from, model.start);
  if (to <= begin || porosity >= model.porosity_max || !erodes(model)) return porosity;
  const LocalState state = local_state(model, porosity, begin, flux);
  return bounded(model.law->porosity_after(model, state, to - begin), porosity, model.porosity_max);
}

double exact_porosity(const ErosionModel& model, double initial_porosity, double time,
                      double flux) {
  if (time <= model.start || initial_porosity >= model.porosity_max || !erodes(model)) {
    return initial_porosity;
  }
  if (model.law->exact_porosity == nullptr) return unset;
  const LocalState state = local_state(model, initial_porosity, model.start, flux);
  return bounded(model.law->exact_porosity(model, state, time - model.start), initial_porosity,
                 model.porosity_max);
}

bool has_exact_porosity(const ErosionModel& model) {
  return !erodes(model) || (model.law->exact_porosity != nullptr && !model.law->depends_on_flux);
}

double exhaustion_time(const ErosionModel& model, double initial_porosity) {
  if (initial_porosity >= model.porosity_max) return model.start;
  if (!erodes(model) || model.law->exhaustion == nullptr) {
    return std::numeric_limits<double>::infinity();
  }
  return model.start + model.law->exhaustion(model, initial_porosity);
}

std::vector<double> breakpoints(const ErosionModel& model, double initial_porosity) {
  if (!erodes(model)) return {};
  std::vector<double> times{model.start};
  const double end = exhaustion_time(model, initial_porosity);
  if (end > model.start && std::isfinite(end)) times.push_back(end);
  return times;
}

}  // namespace suffuse
