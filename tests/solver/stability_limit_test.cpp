#include "explicit/stability_limit.hpp"

#include <gtest/gtest.h>

#include "reference_table.hpp"

namespace suffuse {
namespace stability_limit_test {

TEST(StableStep, AgreesWithEigenvaluesOfTheAmplificationMatrix) {
  for (const auto& row : read_reference("critical-step-rigid.csv")) {
    const double omega = row.number("omega");
    const double a = row.number("a");
    EXPECT_NEAR(stable_step(omega, a, DragIntegration::explicit_drag) / row.number("dt_expl_num"),
                1.0, 1e-6);
    EXPECT_NEAR(stable_step(omega, a, DragIntegration::implicit_drag) / row.number("dt_impl_num"),
                1.0, 1e-6);
  }
}

TEST(StableStep, TendsToTwiceTheRelaxationTimeForStrongDrag) {
  EXPECT_NEAR(stable_step(1.0, 1e9, DragIntegration::explicit_drag) * 1e9, 2.0, 1e-12);
}

}  // namespace stability_limit_test
}  // namespace suffuse
