#include "physics/exchange.hpp"

#include <algorithm>
#include <array>

#include "physics/drag.hpp"

namespace suffuse {
namespace {

/// The state for the drive at |q| = `flux`.
LocalState drive_state(const ExchangeModel& model, const SoilPlace& place, const PlaceFlow& flow,
                       double flux) {
  LocalState state{.porosity = place.porosity, .flux = flux};
  if (!model.drive_depends_on_conductivity()) return state;
  const double weight = model.water_density * conductivity_gravity;
  const double clean =
      place.conductivity_factor * model.conductivity.at(place.initial_porosity, place.porosity);
  const double thickening =
      model.viscosity.depends_on_concentration() ? model.viscosity.ratio(flow.concentration) : 1.0;
  state.unit_weight = weight;
  state.permeability = clean / flow.resistance * model.water_viscosity / weight;
  state.drag_gradient = flux > 0.0 ? flow.resistance * thickening * flux / clean : flux;
  if (model.ergun) {
    const double size = ergun_grain_size(model.conductivity.conductivity, place.initial_porosity,
                                         model.water_density, model.water_viscosity);
    const double b = ergun_quadratic_drag(place.porosity, model.water_density, size);
    state.drag_gradient += b * flux * flux / weight;
  }
  return state;
}

/// lambda_d |q|, 1/s; zero if nothing is deposited or points book their deposits themselves.
double catch_rate(const DepositionModel& deposition, const PlaceFlow& flow, double flux) {
  const bool catches = flow.motion != LiquidMotion::passes && deposition.deposits();
  if (!std::isnan(flow.deposition_flux)) flux = flow.deposition_flux;
  return catches && flux < deposition.flux_max ? deposition.coefficient * flux : 0.0;
}

/// Exchange in a unit volume of soil; x is the net volume of fines given to the liquid.
class SoilVolume {
 public:
  /// `scaled`: S of the step; `caught`: lambda_d |q| times its duration.
  SoilVolume(const ExchangeModel& model, const SoilPlace& place, const PlaceFlow& flow,
             double scaled, double caught)
      : model_(model),
        place_(place),
        scaled_(scaled),
        caught_(caught),
        liquid_(place.porosity * flow.saturation),
        fines_(flow.concentration * liquid_),
        stays_(flow.motion == LiquidMotion::stays),
        erodible_(erodes(model.erosion) ? model.erosion.porosity_max - place.porosity -
                                              model.erosion.residual.at(flow.flux())
                                        : 0.0) {}

  /// Rates at x, per step. With `erodes` the law is continued smoothly beyond the erodible
  /// fraction; the step is then cut at that point.
  [[nodiscard]] Exchange rate(double x, bool erodes) const {
    const double porosity = place_.porosity + x;
    const double concentration = stays_ ? (fines_ + x) / (liquid_ + x) : fines_ / liquid_;
    Exchange result;
    // The rate is negative for negative concentration or room: `find_balance` needs this.
    if (caught_ != 0.0) {
      const double room = model_.deposition.room(place_.initial_porosity, porosity);
      result.deposited = caught_ * concentration * room;
    }
    if (scaled_ == 0.0 || !erodes) return result;
    const double critical = model_.erosion.critical_concentration;
    const double hindrance = std::isfinite(critical) ? concentration / critical : 0.0;
    if (hindrance >= 1.0) return result;
    const LocalState state{
        .porosity = porosity, .erodible_fraction = erodible_ - x, .concentration = concentration};
    result.eroded = scaled_ * (1.0 - hindrance) * model_.erosion.law->state(state);
    return result;
  }

  /// Rate of exchange at this time. Nothing erodes if the erodible fraction is round-off.
  [[nodiscard]] Exchange rate_now() const { return rate(0.0, erodible_ > 0.0 && !is_bare(0.0)); }
  [[nodiscard]] Exchange integrated() const;

 private:
  struct Step {
    double x;
    double deposited;
    double error;
  };
  [[nodiscard]] Step step(double x, double h, bool erodes) const;
  /// Largest volume that can be deposited.
  [[nodiscard]] double available() const {
    return stays_ ? fines_ : std::numeric_limits<double>::infinity();
  }
  /// x at which deposits have filled all room; 0 in soil without room.
  [[nodiscard]] double least_change() const {
    if (!model_.deposition.has_room_limit()) return -std::numeric_limits<double>::infinity();
    return std::min(0.0, model_.deposition.porosity_min - place_.porosity);
  }
  /// Whether the erodible fraction is zero within round-off.
  [[nodiscard]] bool is_bare(double x) const {
    constexpr double round_off = 4.0 * std::numeric_limits<double>::epsilon();
    return std::abs(erodible_ - x) <= round_off;
  }
  /// Whether a stable balance of erosion and deposition is near `x`. If so, sets `x` to it.
  [[nodiscard]] bool find_balance(double& x, bool erodes) const;

  const ExchangeModel& model_;
  const SoilPlace& place_;
  double scaled_;
  double caught_;
  double liquid_;
  double fines_;
  bool stays_;
  double erodible_;
};

/// One step of Dormand and Prince (J. Comput. Appl. Math. 6 (1980) 19) for x and the deposits.
auto SoilVolume::step(double x, double h, bool erodes) const -> Step {
  static constexpr std::array<std::array<double, 6>, 6> weights{
      {{1.0 / 5},
       {3.0 / 40, 9.0 / 40},
       {44.0 / 45, -56.0 / 15, 32.0 / 9},
       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
       {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}}};
  static constexpr std::array<double, 7> error_weights{
      71.0 / 57600, 0.0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
  std::array<Exchange, 7> rates{rate(x, erodes)};
  Step result{x, 0.0, 0.0};
  for (std::size_t stage = 0; stage < weights.size(); ++stage) {
    Exchange sum;
    for (std::size_t i = 0; i <= stage; ++i) {
      sum.eroded += weights[stage][i] * rates[i].eroded;
      sum.deposited += weights[stage][i] * rates[i].deposited;
    }
    result.x = x + h * sum.into_liquid();
    result.deposited = h * sum.deposited;
    rates[stage + 1] = rate(result.x, erodes);
  }
  double error = 0.0;
  for (std::size_t i = 0; i < rates.size(); ++i) error += error_weights[i] * rates[i].into_liquid();
  result.error = h * std::abs(error);
  return result;
}

bool SoilVolume::find_balance(double& x, bool erodes) const {
  constexpr double little = 2e-11;  // the accuracy of the steps
  const auto grows = [&](double at) { return rate(at, erodes).into_liquid() > 0.0; };
  double low = x - little;
  double high = x + little;
  if (!grows(low) || !(rate(high, erodes).into_liquid() < 0.0)) return false;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (low + high);
    (grows(middle) ? low : high) = middle;
  }
  x = std::clamp(0.5 * (low + high), -available(), erodes ? std::max(x, erodible_) : x + little);
  return true;
}

Exchange SoilVolume::integrated() const {
  constexpr double tolerance = 1e-11;
  constexpr int many_steps = 10000;
  double x = 0.0;
  double deposited = 0.0;
  double done = 0.0;
  double h = 1.0;
  bool erodes = erodible_ > 0.0;
  bool stuck = false;
  for (int count = 0; done < 1.0; ++count) {
    // Fines deposited on bare grains erode at once if the law can erode that much.
    const bool bare = is_bare(x);
    const bool stays = bare && (rate(x, true).into_liquid() >= 0.0 || stuck);
    if (stays) {
      deposited += (1.0 - done) * rate(x, true).deposited;
      break;
    }
    const double before = x;
    if (h < 0.01 && find_balance(x, erodes)) {
      // Both rates are equal except for the round-off of x in the faster one.
      const Exchange even = rate(x, erodes);
      const double change = (1.0 - done) * std::min(even.eroded, even.deposited);
      deposited += std::max(0.0, change) + std::max(0.0, before - x);
      break;
    }
    erodes = erodes || bare;
    h = std::min(h, 1.0 - done);
    Step next = step(x, h, erodes);
    // Without deposition x must not decrease, which the error of a step could cause.
    if (caught_ == 0.0) next.x = std::max(next.x, x);
    const double shortest = count < many_steps ? 1e-15 : 1e-4;
    const double factor = 0.9 * std::pow(tolerance / std::max(next.error, 1e-300), 0.2);
    // The error is NaN if a stage leaves the range of the law.
    const bool fails = !(next.error <= tolerance);
    if (fails && h > shortest) {
      h = std::max(shortest, h * std::max(0.2, factor));
      continue;
    }
    // The step crosses the end of the erodible fines, from either side.
    const bool crosses = erodes ? next.x > erodible_ && next.x > x : next.x < erodible_;
    const double share = crosses ? std::clamp((erodible_ - x) / (next.x - x), 0.0, 1.0) : 1.0;
    stuck = crosses && share == 0.0;
    const double missing = crosses ? 0.0 : std::max(0.0, -available() - next.x);
    x = crosses ? erodible_ : next.x + missing;
    deposited += share * next.deposited - missing;
    done += fails ? h : share * h;
    h = std::max(shortest, h * std::min(5.0, factor));
  }
  // Deposits must not exceed the room, which the error of a step could cause.
  const double beyond = least_change() - x;
  if (caught_ != 0.0 && beyond > 0.0) {
    x += beyond;
    deposited = std::max(0.0, deposited - beyond);
  }
  return {x + deposited, deposited};
}

}  // namespace

double drive_at(const ExchangeModel& model, const SoilPlace& place, const PlaceFlow& flow,
                double flux) {
  const DriveLaw& drive = *model.erosion.drive;
  return drive.depends_on_flow() ? drive.value(drive_state(model, place, flow, flux)) : 1.0;
}

Exchange exchange_rate(const ExchangeModel& model, const SoilPlace& place, const PlaceFlow& flow,
                       double time) {
  const bool erodes_now = erodes(model.erosion) && time >= model.erosion.start;
  const double drive =
      erodes_now ? drive_rate(model.erosion, drive_at(model, place, flow, flow.flux_start)) : 0.0;
  PlaceFlow now = flow;
  now.flux_end = flow.flux_start;
  return SoilVolume(model, place, now, drive, catch_rate(model.deposition, flow, flow.flux_start))
      .rate_now();
}

Exchange exchange_over(const ExchangeModel& model, const SoilPlace& place, const PlaceFlow& flow,
                       double from, double to) {
  const auto with_drives = [&](double first, double last) -> Exchange {
    const double scaled = scaled_time(model.erosion, from, to, first, last);
    const bool catches = flow.motion != LiquidMotion::passes && model.deposition.deposits();
    if (!depends_on_concentration(model.erosion) && !catches) {
      return {porosity_after_scaled(model.erosion, place.porosity, scaled, flow.flux()) -
                  place.porosity,
              0.0};
    }
    const double caught = catch_rate(model.deposition, flow, flow.flux()) * (to - from);
    if (scaled == 0.0 && (caught == 0.0 || flow.concentration <= 0.0)) return {};
    // The drive is infinite if the grains lock.
    if (!std::isfinite(scaled)) return {scaled, unset};
    return SoilVolume(model, place, flow, scaled, caught).integrated();
  };
  if (!erodes(model.erosion) || to <= model.erosion.start) return with_drives(0.0, 0.0);
  const double first = drive_at(model, place, flow, flow.flux_start);
  const bool opens =
      model.drive_depends_on_conductivity() && model.conductivity.depends_on_porosity();
  if (!opens && flow.flux_end == flow.flux_start) return with_drives(first, first);
  if (!opens) return with_drives(first, drive_at(model, place, flow, flow.flux_end));
  const double predicted = place.porosity + with_drives(first, first).into_liquid();
  return with_drives(
      first, drive_at(model, {place.initial_porosity, predicted, place.conductivity_factor}, flow,
                      flow.flux_end));
}

}  // namespace suffuse
