/// The factor of the elastic stiffness that successive equilibria keep.

#include "equilibrium/kept_stiffness.hpp"

#include <gtest/gtest.h>

#include "equilibrium/step_equilibrium.hpp"
#include "results/state_archive.hpp"
#include "solver/solid_model.hpp"

namespace suffuse {
namespace kept_stiffness_test {

/// A block of soil on a rough base, whose elements share their dilatation.
class Block {
 public:
  /// Soil below this height, m.
  explicit Block(double height = 1.0)
      : model_(model::column_mesh(4, 4, 1.0, 1.0, model::jittered(0.05, 3)),
               model::places_in_triangle(3), model::elastic_soil(1e7, 0.45),
               [&](const Vector<2>& x) { return x[1] < height; }) {
    model_.support("bottom", Support::both);
    supports_ = std::make_unique<Supports<2>>(model_.grid, model_.face_support);
  }

  /// Displacement under its weight, N/m3, with soil `stiffer` times as stiff.
  NodeVectors<2> displacement(double weight, const std::shared_ptr<KeptStiffness<2>>& kept,
                              double stiffer = 1.0) {
    std::vector<PointSkeleton> skeleton = model_.skeleton;
    for (PointSkeleton& of_point : skeleton) of_point.parameters.young *= stiffer;
    StepEquilibrium<2> step(model_.grid, model_.points, skeleton, *supports_, 1, {},
                            SoftStiffness(), kept);
    EXPECT_TRUE(step.solve(model_.weight(weight), {}));
    return step.displacement();
  }
  [[nodiscard]] const Mesh<2>& mesh() const { return model_.mesh; }
  [[nodiscard]] const Supports<2>& supports() const { return *supports_; }

 private:
  model::SolidModel<2> model_;
  std::unique_ptr<Supports<2>> supports_;
};

double difference(const NodeVectors<2>& a, const NodeVectors<2>& b) {
  NodeVectors<2> change = a;
  for (std::size_t i = 0; i < a.size(); ++i) change[i] -= b[i];
  return norm<2>(change) / norm<2>(b);
}

long factors(const std::shared_ptr<KeptStiffness<2>>& kept) {
  return kept->system.counts().factorisations;
}

TEST(KeptStiffness, ServesLaterStepsOfTheSameElements) {
  Block block;
  const auto kept = std::make_shared<KeptStiffness<2>>();
  block.displacement(1e4, kept);
  const auto pattern = kept->pattern;
  // Soil that is a little stiffer converges with the old factor, to the same displacement.
  const NodeVectors<2> found = block.displacement(2e4, kept, 1.02);
  EXPECT_EQ(factors(kept), 1);
  EXPECT_EQ(kept->pattern, pattern);
  const auto fresh = std::make_shared<KeptStiffness<2>>();
  EXPECT_LE(difference(found, block.displacement(2e4, fresh, 1.02)), 1e-8);
}

TEST(KeptStiffness, IsRenewedWhereSoilHasBecomeMuchStiffer) {
  Block block;
  const auto kept = std::make_shared<KeptStiffness<2>>();
  block.displacement(1e4, kept);
  const NodeVectors<2> found = block.displacement(1e4, kept, 4.0);
  EXPECT_EQ(factors(kept), 2);
  EXPECT_LE(difference(found, block.displacement(1e4, std::make_shared<KeptStiffness<2>>(), 4.0)),
            1e-8);
}

TEST(KeptStiffness, IsDroppedWhereOtherElementsHaveSoil) {
  Block block;
  Block lower(0.6);
  const auto kept = std::make_shared<KeptStiffness<2>>();
  block.displacement(1e4, kept);
  const auto pattern = kept->pattern;
  const NodeVectors<2> found = lower.displacement(1e4, kept);
  EXPECT_NE(kept->pattern, pattern);
  EXPECT_EQ(found, lower.displacement(1e4, std::make_shared<KeptStiffness<2>>()));
}

/// A resumed run has the bits of the run that went on.
TEST(KeptStiffness, IsRestoredWithTheSameBits) {
  Block block;
  const auto kept = std::make_shared<KeptStiffness<2>>();
  block.displacement(1e4, kept);
  StateArchive collects;
  kept->archive(collects, block.mesh(), block.supports());
  StateArchive restores(collects.finish());
  const auto restored = std::make_shared<KeptStiffness<2>>();
  Block(0.6).displacement(1e4, restored);  // other elements before: estimates restore like this
  restored->archive(restores, block.mesh(), block.supports());
  restores.finish();
  EXPECT_EQ(block.displacement(2e4, restored, 1.02), block.displacement(2e4, kept, 1.02));
  EXPECT_EQ(factors(restored), 0);
  EXPECT_NE(block.displacement(2e4, restored, 1.02),
            block.displacement(2e4, std::make_shared<KeptStiffness<2>>(), 1.02));
}

}  // namespace kept_stiffness_test
}  // namespace suffuse
