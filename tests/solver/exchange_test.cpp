#include "physics/exchange.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace suffuse {
namespace exchange_test {

constexpr double n_0 = 0.35;
constexpr double n_max = 0.55;

ExchangeModel some_model() {
  ExchangeModel model;
  model.erosion.porosity_max = n_max;
  model.conductivity = {conductivity_law("kozeny-carman"), 2e-2, 1.0 - n_max};
  model.water_density = 1000.0;
  model.water_viscosity = 1e-3;
  return model;
}

ExchangeModel that_catches(double coefficient) {
  ExchangeModel model = some_model();
  model.deposition.coefficient = coefficient;
  return model;
}

ExchangeModel that_erodes(const char* law, const char* drive, double rate) {
  ExchangeModel model = some_model();
  model.erosion.law = erosion_law(law);
  model.erosion.drive = drive_law(drive);
  model.erosion.rate = rate;
  return model;
}

PlaceFlow flow_of(double flux, double concentration) {
  return {.flux_start = flux, .flux_end = flux, .concentration = concentration};
}

TEST(Drives, HaveTheirUnits) {
  std::set<std::string_view> words;
  for (const DriveLaw* drive : drive_laws()) {
    EXPECT_EQ(drive_law(drive->word), drive);
    EXPECT_FALSE(drive->rate_unit.empty());
    EXPECT_EQ(drive->unit.empty(), !drive->depends_on_flow());
    words.insert(drive->word);
  }
  EXPECT_EQ(words.size(), drive_laws().size());
  EXPECT_THROW(drive_law("shear"), std::invalid_argument);
}

TEST(Drives, HaveTheirValues) {
  const double flux = 0.012;
  const double k = 2e-2;
  const double gradient = flux / k;
  const double kappa = k * 1e-3 / (1000.0 * 9.81);
  const auto rate = [&](const char* drive) {
    const ExchangeModel m = that_erodes("constant", drive, 1.0);
    return exchange_rate(m, {n_0, n_0, 1.0}, flow_of(flux, 0.0), 0.0).eroded;
  };
  EXPECT_EQ(rate("time"), 1.0);
  EXPECT_EQ(rate("flux"), flux);
  EXPECT_NEAR(rate("gradient"), gradient, 1e-15);
  EXPECT_NEAR(rate("shear-stress"), 9810.0 * gradient * std::sqrt(2.0 * kappa / n_0), 1e-12);
  EXPECT_NEAR(rate("power"), 9810.0 * gradient * flux, 1e-12);
}

/// The gradient is that of the flow: with Ergun's drag, along and across bedding, under suction,
/// and in a thick suspension.
TEST(Drives, FollowTheGradientOfTheFlow) {
  const double flux = 0.012;
  ExchangeModel m = that_erodes("constant", "gradient", 1.0);
  const auto gradient = [&](const PlaceFlow& flow) {
    return exchange_rate(m, {n_0, n_0, 1.0}, flow, 0.0).eroded;
  };
  const double darcy = gradient(flow_of(flux, 0.1));
  PlaceFlow across = flow_of(flux, 0.1);
  across.resistance = 4.0;
  EXPECT_NEAR(gradient(across), 4.0 * darcy, 1e-14);
  m.viscosity = {viscosity_laws()[1], 0.62};
  EXPECT_NEAR(gradient(flow_of(flux, 0.1)) / darcy, std::pow(1.0 - 0.1 / 0.62, -1.55), 1e-13);
  m.viscosity = {};
  m.ergun = true;
  EXPECT_GT(gradient(flow_of(flux, 0.1)), darcy);
  // At half the flux the linear part is half, the quadratic part a quarter.
  const double whole = gradient(flow_of(flux, 0.1));
  const double half = gradient(flow_of(0.5 * flux, 0.1));
  EXPECT_NEAR(4.0 * half - whole, darcy, 1e-13);
}

TEST(ScaledTime, CountsWhatIsAboveTheThreshold) {
  ErosionModel m;
  m.law = erosion_law("first-order");
  m.drive = drive_law("gradient");
  m.rate = 2.0;
  m.start = 10.0;
  m.threshold = 0.3;
  EXPECT_NEAR(scaled_time(m, 10.0, 20.0, 0.5, 0.5), 2.0 * 0.2 * 10.0, 1e-14);
  EXPECT_NEAR(scaled_time(m, 0.0, 20.0, 0.5, 0.5), 2.0 * 0.2 * 10.0, 1e-14);
  EXPECT_NEAR(scaled_time(m, 10.0, 20.0, 0.4, 0.6), 2.0 * 0.2 * 10.0, 1e-14);
  // The excess over the threshold is a triangle over half the time, rising or falling.
  EXPECT_NEAR(scaled_time(m, 10.0, 20.0, 0.1, 0.5), 2.0 * 0.1 * 5.0, 1e-14);
  EXPECT_NEAR(scaled_time(m, 10.0, 20.0, 0.5, 0.1), 2.0 * 0.1 * 5.0, 1e-14);
  EXPECT_EQ(scaled_time(m, 10.0, 20.0, 0.1, 0.2), 0.0);
  EXPECT_EQ(scaled_time(m, 0.0, 10.0, 0.5, 0.5), 0.0);
}

TEST(Residual, IsLinearBetweenItsPairs) {
  const ResidualFraction residual{{{1e-3, 0.08}, {3e-3, 0.05}, {1e-2, 0.01}}};
  EXPECT_EQ(residual.at(0.0), 0.08);
  EXPECT_NEAR(residual.at(2e-3), 0.065, 1e-16);
  EXPECT_EQ(residual.at(3e-3), 0.05);
  EXPECT_EQ(residual.at(1.0), 0.01);
  EXPECT_TRUE(std::isnan(residual.at(unset)));
  EXPECT_EQ(ResidualFraction{}.at(unset), 0.0);
  EXPECT_EQ((ResidualFraction{{{0.0, 0.02}}}.at(unset)), 0.02);
}

TEST(Residual, StaysWhateverTheLaw) {
  for (const char* law : {"constant", "logarithmic", "first-order"}) {
    ExchangeModel m = that_erodes(law, "time", 1.0);
    m.erosion.residual = {{{0.0, 0.05}}};
    EXPECT_NEAR(exchange_over(m, {n_0, n_0, 1.0}, {}, 0.0, 1e4).eroded, 0.15, 1e-12) << law;
    // Erosion does not become negative if the residual grows as the flow slows down.
    EXPECT_EQ(exchange_over(m, {n_0, 0.52, 1.0}, {}, 0.0, 1e4).eroded, 0.0) << law;
  }
}

/// f' = -a f / (w + f) with the water w: f + w ln f falls by a.
TEST(Deposition, CatchesFinesOfAClosedVolume) {
  const double c = 0.05;
  const double w = n_0 * (1.0 - c);
  const auto invariant = [&](double fines) { return fines + w * std::log(fines); };
  for (const double a : {1e-3, 0.1, 1.0, 5.0}) {
    const Exchange x =
        exchange_over(that_catches(2.0), {n_0, n_0, 1.0}, flow_of(1e-3, c), 0.0, a / (2.0 * 1e-3));
    EXPECT_EQ(x.eroded, 0.0);
    const double left = n_0 * c - x.deposited;
    EXPECT_NEAR(invariant(n_0 * c) - invariant(left), a, 1e-9 * (1.0 + w / left)) << a;
  }
  const Exchange all =
      exchange_over(that_catches(2.0), {n_0, n_0, 1.0}, flow_of(1e-3, c), 0.0, 1e9);
  EXPECT_NEAR(all.deposited, n_0 * c, 1e-10);
  EXPECT_LE(all.deposited, n_0 * c + 1e-11);
}

TEST(Deposition, EndsWhereTheFlowIsFastOrRoomIsGone) {
  ExchangeModel m = that_catches(2.0);
  m.deposition.flux_max = 1e-3;
  EXPECT_EQ(exchange_over(m, {n_0, n_0, 1.0}, flow_of(1e-3, 0.1), 0.0, 10.0).deposited, 0.0);
  EXPECT_GT(exchange_over(m, {n_0, n_0, 1.0}, flow_of(0.9e-3, 0.1), 0.0, 10.0).deposited, 0.0);
  m = that_catches(2.0);
  m.deposition.porosity_min = 0.34;
  const Exchange x = exchange_over(m, {n_0, n_0, 1.0}, flow_of(1e-3, 0.3), 0.0, 1e7);
  EXPECT_LE(x.deposited, 0.01 + 1e-11);
  EXPECT_NEAR(x.deposited, 0.01, 1e-9);
}

/// n' = S (n_max - n) (n - w) / n in a closed volume with the water w, by separation.
TEST(Autocatalysis, GrowsAsItsIntegralSays) {
  const double c = 0.05;
  const double w = n_0 * (1.0 - c);
  const auto clock = [&](double n) {
    return (-n_max * std::log(n_max - n) + w * std::log(n - w)) / (n_max - w);
  };
  for (const double s : {0.1, 1.0, 10.0, 30.0}) {
    const ExchangeModel m = that_erodes("autocatalytic", "flux", 8.0);
    const Exchange x = exchange_over(m, {n_0, n_0, 1.0}, flow_of(1e-3, c), 0.0, s / 8e-3);
    const double n = n_0 + x.eroded;
    EXPECT_NEAR(clock(n) - clock(n_0), s, 1e-8 / (n_max - n)) << s;
  }
  const ExchangeModel m = that_erodes("autocatalytic", "flux", 8.0);
  EXPECT_EQ(exchange_over(m, {n_0, n_0, 1.0}, flow_of(1e-3, 0.0), 0.0, 1e3).eroded, 0.0);
}

/// The last fines are fewer than the steps of the integral resolve: n_e = n_e0 exp(-S c).
TEST(Autocatalysis, GivesNothingBack) {
  const double c = 0.05;
  const ExchangeModel m = that_erodes("autocatalytic", "time", 1.0);
  for (double left = 1e-14; left < 1e-8; left *= 3.0) {
    for (double s = 1.0; s < 100.0; s *= 1.3) {
      PlaceFlow flow = flow_of(0.0, c);
      flow.motion = LiquidMotion::flows_on;
      const Exchange x = exchange_over(m, {n_0, n_max - left, 1.0}, flow, 0.0, s / c);
      EXPECT_GE(x.eroded, 0.0) << left << ' ' << s;
      EXPECT_EQ(x.deposited, 0.0) << left << ' ' << s;
      EXPECT_NEAR(x.eroded, left * (1.0 - std::exp(-s)), 1e-11) << left << ' ' << s;
    }
  }
}

/// Clean liquid leaves no deposits: soil that can catch fines erodes like soil that cannot, whose
/// erosion is exact. Steps of the integral may reach places where the law has no value.
TEST(Exchange, OfCleanLiquidIsErosionAlone) {
  for (const char* law : {"constant", "logarithmic", "first-order"}) {
    for (double rate = 1e-4; rate < 1e4; rate *= 1.7) {
      ExchangeModel m = that_erodes(law, "time", rate);
      m.erosion.residual = {{{0.0, 0.05}}};
      const double alone = exchange_over(m, {n_0, n_0, 1.0}, flow_of(1e-5, 0.0), 0.0, 1.0).eroded;
      m.deposition.coefficient = 2.0;
      PlaceFlow flow = flow_of(1e-5, 0.0);
      flow.motion = LiquidMotion::flows_on;
      const Exchange both = exchange_over(m, {n_0, n_0, 1.0}, flow, 0.0, 1.0);
      EXPECT_NEAR(both.eroded, alone, 1e-9) << law << ' ' << rate;
      EXPECT_EQ(both.deposited, 0.0) << law << ' ' << rate;
    }
  }
}

/// The search for the concentration that balances an element also tries values at which grains
/// lock.
TEST(Exchange, InLockedLiquidHasNoValue) {
  ExchangeModel m = that_erodes("logarithmic", "power", 1.0);
  m.deposition.coefficient = 2.0;
  m.viscosity = {viscosity_laws()[1], 0.62};
  PlaceFlow flow = flow_of(1e-5, 1.0);
  flow.motion = LiquidMotion::flows_on;
  EXPECT_FALSE(std::isfinite(exchange_over(m, {n_0, n_0, 1.0}, flow, 0.0, 1.0).into_liquid()));
  flow.concentration = 0.61;
  EXPECT_TRUE(std::isfinite(exchange_over(m, {n_0, n_0, 1.0}, flow, 0.0, 1.0).into_liquid()));
}

/// The porosity at the end of erosion is a sum, whose last digits are round-off.
TEST(ConstantErosion, EndsWithTheLastDigitsOfPorosity) {
  const ExchangeModel m = that_erodes("constant", "time", 1e-3);
  const double most = m.erosion.porosity_max;
  const auto rate = [&](double left) {
    return exchange_rate(m, {n_0, most - left, 1.0}, flow_of(0.0, 0.0), 0.0).eroded;
  };
  EXPECT_GT(rate(1e-12), 0.0);
  for (const double left : {2e-16, 1e-16, 0.0, -1e-16}) EXPECT_EQ(rate(left), 0.0) << left;
}

TEST(CriticalConcentration, StopsErosion) {
  ExchangeModel m = that_erodes("constant", "time", 1e-3);
  m.erosion.critical_concentration = 0.1;
  EXPECT_NEAR(exchange_rate(m, {n_0, n_0, 1.0}, flow_of(0.0, 0.1), 0.0).eroded, 0.0, 1e-18);
  EXPECT_NEAR(exchange_rate(m, {n_0, n_0, 1.0}, flow_of(0.0, 0.05), 0.0).eroded, 5e-4, 1e-18);
  const Exchange x = exchange_over(m, {n_0, n_0, 1.0}, flow_of(0.0, 0.0), 0.0, 1e5);
  EXPECT_NEAR(x.eroded / (n_0 + x.eroded), 0.1, 1e-9);
}

/// On soil without erodible fines, new deposits erode at once if erosion is faster.
TEST(Exchange, SlidesAlongWhatCanErode) {
  ExchangeModel m = that_erodes("constant", "time", 1e-3);
  m.deposition.coefficient = 2.0;
  const double c = 0.1;
  const Exchange x = exchange_over(m, {n_0, n_max, 1.0}, flow_of(1e-3, c), 0.0, 10.0);
  EXPECT_NEAR(x.into_liquid(), 0.0, 1e-6);
  // From a little below, all erodible fines are eroded, and nothing more.
  const Exchange y = exchange_over(m, {n_0, n_max - 1e-3, 1.0}, flow_of(1e-3, c), 0.0, 10.0);
  EXPECT_NEAR(y.into_liquid(), 1e-3, 1e-12);
  EXPECT_GT(y.deposited, 1.9e-3);
  EXPECT_NEAR(y.deposited, 2e-3, 1e-4);
}

/// On bare grains a law that erodes at least the deposits leaves the porosity as it is; a slower
/// one lets it fall as c' = (S - a c)/n with n almost constant.
TEST(Exchange, StartsOnBareGrains) {
  ExchangeModel m = that_erodes("constant", "time", 1e-2);
  m.deposition.coefficient = 1.0;
  const double c = 0.05;
  const double flux = 1e-2;
  // The last bit of the state must not matter.
  for (const double porosity : {n_max, std::nextafter(n_max, 0.0), std::nextafter(n_max, 1.0)}) {
    const Exchange x = exchange_over(m, {n_0, porosity, 1.0}, flow_of(flux, c), 0.0, 10.0);
    EXPECT_NEAR(x.into_liquid(), 0.0, 1e-15);
    EXPECT_NEAR(x.deposited, flux * c * 10.0, 1e-15);
    EXPECT_NEAR(x.eroded, x.deposited, 1e-15);
  }
  m.erosion.rate = 1e-4;
  const double duration = 1.0;
  const Exchange less = exchange_over(m, {n_0, n_max, 1.0}, flow_of(flux, c), 0.0, duration);
  EXPECT_NEAR(less.eroded, 1e-4 * duration, 1e-12);
  EXPECT_NEAR(less.deposited, flux * c * duration, 0.01 * flux * c * duration);
}

/// With fewer fines than the residual, nothing erodes until fines have been deposited.
TEST(Exchange, WaitsForDepositsWhereLessThanTheResidualIsLeft) {
  ExchangeModel m = that_erodes("constant", "time", 1.0);
  m.deposition.coefficient = 1.0;
  m.erosion.residual = {{{0.0, 0.001}}};
  const double porosity = n_max - 1e-4;
  const Exchange x = exchange_over(m, {n_0, porosity, 1.0}, flow_of(1e-2, 0.5), 0.0, 10.0);
  EXPECT_NEAR(x.into_liquid(), -9e-4, 1e-15);
  // As fines are deposited, c falls by less than 1 %; deposits above the residual erode at once.
  EXPECT_NEAR(x.deposited, 1e-2 * 0.5 * 10.0, 1e-4);
  EXPECT_LT(x.deposited, 1e-2 * 0.5 * 10.0);
}

TEST(Exchange, IsTheIntegralOfItsRates) {
  ExchangeModel m = that_erodes("first-order", "gradient", 0.05);
  m.erosion.threshold = 0.1;
  m.erosion.critical_concentration = 0.5;
  m.deposition.coefficient = 3.0;
  m.deposition.porosity_min = 0.2;
  m.conductivity.law = conductivity_law("constant");
  const double duration = 30.0;
  const double flux = 0.01;
  const int steps = 20000;
  const double h = duration / steps;
  const double w = n_0 * 0.98;
  double n = n_0;
  double deposited = 0.0;
  const auto rate = [&](double porosity) {
    return exchange_rate(m, {n_0, porosity, 1.0}, flow_of(flux, (porosity - w) / porosity), 0.0);
  };
  for (int s = 0; s < steps; ++s) {
    const Exchange middle = rate(n + 0.5 * h * rate(n).into_liquid());
    n += h * middle.into_liquid();
    deposited += h * middle.deposited;
  }
  const Exchange x = exchange_over(m, {n_0, n_0, 1.0}, flow_of(flux, 0.02), 0.0, duration);
  EXPECT_NEAR(n_0 + x.into_liquid(), n, 1e-9);
  EXPECT_NEAR(x.deposited, deposited, 1e-9);
  EXPECT_GT(x.deposited, 1e-3);
}

TEST(Exchange, StaysWithinItsBounds) {
  ExchangeModel m = that_erodes("first-order", "flux", 1e3);
  m.deposition.coefficient = 1e4;
  m.deposition.porosity_min = 0.3;
  for (const double flux : {1e-8, 1e-3, 10.0}) {
    for (const double c : {0.0, 1e-6, 0.2, 0.9}) {
      for (const double duration : {1e-3, 1.0, 1e6}) {
        const Exchange x = exchange_over(m, {n_0, n_0, 1.0}, flow_of(flux, c), 0.0, duration);
        const double n = n_0 + x.into_liquid();
        EXPECT_GE(n, 0.3 - 1e-15);
        EXPECT_LE(n, n_max + 1e-15);
        EXPECT_GE(n_0 * c + x.into_liquid(), -1e-17);
        EXPECT_GE(x.deposited, 0.0);
        EXPECT_GE(x.eroded, -1e-10);
      }
    }
  }
}

TEST(ConductivityLaws, KnowTheFines) {
  // n_C + r n_e: 0.45 + 4 * 0.2 at the start, 0.45 + 4 * 0.1 after half has gone.
  ConductivityModel model{conductivity_law("kozeny-carman"), 1e-3, 0.45, {.size_ratio = 4.0}};
  const double expected = 1e-3 * std::pow(0.45 / 0.35, 3) * std::pow(1.25 / 0.85, 2);
  EXPECT_NEAR(model.at(0.35, 0.45), expected, 1e-15 * 10);
  model = {conductivity_law("power"), 1e-3, 0.45, {.exponent = 5.0}};
  EXPECT_NEAR(model.at(0.35, 0.45), 1e-3 * std::pow(0.45 / 0.35, 5), 1e-17);
}

TEST(Viscosity, IsEinsteinsWhereThereIsLittle) {
  const ViscosityModel model{viscosity_laws()[1], 0.62};
  EXPECT_EQ(model.ratio(0.0), 1.0);
  EXPECT_NEAR((model.ratio(1e-6) - 1.0) / 1e-6, 2.5, 1e-4);
  EXPECT_NEAR(model.ratio(0.31), std::pow(0.5, -1.55), 1e-14);
  EXPECT_TRUE(std::isinf(model.ratio(0.62)));
  EXPECT_EQ(ViscosityModel{}.ratio(0.5), 1.0);
}

}  // namespace exchange_test
}  // namespace suffuse
