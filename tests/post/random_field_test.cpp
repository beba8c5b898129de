/// Flow through a conductivity that varies with the height alone, against the sum of resistances.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "post/run_programs.hpp"
#include "values/derived_fields.hpp"

namespace suffuse {
namespace random_field_test {

using testing::run_programs;
using testing::ScratchFolder;

constexpr double conductivity = 1e-4;
constexpr double height = 4.0;

std::string scene(double size, const std::string& erosion = {}) {
  std::ostringstream text;
  text << "formulation = \"single-point\"\n"
       << "geometry = { shape = \"column\", width = " << 2.0 * size << ", height = " << height
       << " }\nmesh.size = " << size << "\n"
       << "liquid = { density = 1000.0, bulk_modulus = inf, viscosity = 1e-3 }\n"
       << "soil.specimen = { porosity = 0.35, skeleton_fraction = 0.55, grain_density = 2650.0, "
       << "conductivity = " << conductivity << ", field = { variation = 0.8, correlation = [1e6, "
       << "1.0], seed = 7 }" << erosion << " }\n"
       << "boundary = [{ on = \"top\", head = 1.0, concentration = 0.0 }, "
       << "{ on = \"bottom\", head = 0.0 }]\n"
       << "initial.flow = \"steady\"\ntime.end = 1.0\noutput.every = 1.0\n";
  return text.str();
}

/// q = k h / integral of dz / factor, by the midpoint rule.
double exact_flux() {
  const LognormalField field({.variation = 0.8, .along = 1e6, .across = 1.0, .seed = 7}, 0.0);
  constexpr int count = 20000;
  double resistance = 0.0;
  for (int i = 0; i < count; ++i) {
    resistance += height / count / field.at(0.0, 0.0, (i + 0.5) * height / count);
  }
  return conductivity / resistance;
}

TEST(RandomField, DischargeThroughLayersConverges) {
  std::array<double, 3> error{};
  for (int i = 0; i < 3; ++i) {
    const ScratchFolder scratch;
    const double size = 0.2 / (1 << i);
    const ResultsReader results = run_programs(scratch, "field", scene(size));
    const double flux = results.history().column("flux_out").back() / (2.0 * size);
    error[i] = std::abs(flux / exact_flux() - 1.0);
    std::cout << "elements of " << size << " m: flux off by " << error[i] << '\n';
  }
  EXPECT_LT(error[2], 1e-3);
  EXPECT_GT(error[0] / error[2], 8.0);  // order 2 or nearly
}

/// The field that is written is the one that the solver takes: q = k i in each element.
TEST(RandomField, FluxIsConductivityTimesGradient) {
  const ScratchFolder scratch;
  const ResultsReader results = run_programs(scratch, "field", scene(0.1));
  const std::vector<double> k = any_field(results, 0, "cell", "conductivity").values;
  const std::vector<double> gradient = results.field(0, "cell", "hydraulic_gradient").values;
  const std::vector<double> flux = results.field(0, "cell", "darcy_flux").values;
  double least = k[0];
  double most = k[0];
  for (std::size_t e = 0; e < k.size(); ++e) {
    EXPECT_NEAR(k[e] * gradient[2 * e + 1], flux[2 * e + 1], 1e-9 * std::abs(flux[2 * e + 1]));
    least = std::min(least, k[e]);
    most = std::max(most, k[e]);
  }
  EXPECT_GT(most / least, 2.0);
}

/// A drive by the gradient sees the conductivity of the place: where the threshold lies between the
/// least and the largest gradient only the tight elements erode.
TEST(RandomField, ErosionFeelsTheGradientOfThePlace) {
  const ScratchFolder scratch;
  const ResultsReader results =
      run_programs(scratch, "field",
                   scene(0.1,
                         ", erosion = { law = \"first-order\", rate = 1e-3, drive = \"gradient\", "
                         "threshold = 0.3 }"));
  const std::vector<double> gradient = results.field(0, "cell", "hydraulic_gradient").values;
  const std::vector<double> before = results.field(0, "cell", "porosity").values;
  const std::vector<double> after = results.field(1, "cell", "porosity").values;
  int eroded = 0;
  for (std::size_t e = 0; e < before.size(); ++e) {
    const double drive = std::abs(gradient[2 * e + 1]);
    if (std::abs(drive - 0.3) < 1e-3) continue;
    EXPECT_EQ(after[e] > before[e] + 1e-12, drive > 0.3) << drive;
    if (drive > 0.3) ++eroded;
  }
  EXPECT_GT(eroded, 0);
  EXPECT_LT(eroded, static_cast<int>(before.size()));
}

}  // namespace random_field_test
}  // namespace suffuse
