/// suffuse-solver --sizes: sizes that follow a run.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>

#include "case/mesh_sizes.hpp"
#include "solver/solver_process.hpp"
#include "test_paths.hpp"

namespace suffuse {
namespace mesh_again_test {

namespace fs = std::filesystem;

/// Two weirs. Water seeps below the right one only while the river is high.
test::Mode two_weirs() {
  const std::string stem = test::source_folder() + "/workflows/adapt/second-weir";
  return {"weirs",
          test::read_file(stem + ".toml"),
          {"geometry.file=\"" + stem + ".geo\"", "output.restarts=10"}};
}

class MeshAgain : public testing::Test {
 protected:
  struct Answer {
    int code = 0;
    std::string text;   ///< on standard output
    std::string error;  ///< on stderr
  };

  /// Runs the solver with these options.
  [[nodiscard]] Answer solver(const std::string& options) const {
    const std::string out = place_.path("out");
    const std::string error = place_.path("error");
    const std::string command = "cd " + place_.path("") + " && " + test::program_folder() +
                                "/suffuse-solver " + options + " > " + out + " 2> " + error;
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), test::read_file(out), test::read_file(error)};
  }

  /// Makes the case of a mode and runs it into NAME.results.
  void run(const test::Mode& mode) const {
    const std::string path = place_.make_case(mode);
    const Answer answer = solver(path + " --quiet --force -o " + mode.name + ".results");
    ASSERT_EQ(answer.code, 0) << answer.error;
  }

  /// The answer to --sizes for the case NAME, into SIZES.
  [[nodiscard]] Answer ask(const std::string& name, const std::string& sizes,
                           const std::string& options = "") const {
    return solver(name + ".case.h5 --sizes " + sizes + ' ' + options);
  }

  /// The size at the node that is nearest to x, y.
  [[nodiscard]] double size_at(const std::string& sizes, double x, double y) const {
    const MeshSizes<2> read = read_mesh_sizes<2>(place_.path(sizes));
    double nearest = std::numeric_limits<double>::infinity();
    double size = 0.0;
    for (int i = 0; i < read.mesh.node_count(); ++i) {
      const double distance = (read.mesh.nodes[i] - Vector<2>(x, y)).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      size = read.size[i];
    }
    return size;
  }

  void expect_refused(const std::string& options, const std::string& message) const {
    const Answer answer = ask("weirs", "refused.h5", options);
    EXPECT_EQ(answer.code, 2) << answer.text;
    EXPECT_NE(answer.error.find(message), std::string::npos) << answer.error;
    EXPECT_FALSE(fs::exists(place_.path("refused.h5")));
  }

  test::Workplace place_;
};

TEST_F(MeshAgain, FollowsAFlowThatComesLater) {
  run(two_weirs());
  ASSERT_EQ(ask("weirs", "start.h5").code, 0);
  const Answer answer = ask("weirs", "run.h5", "--from weirs.results");
  ASSERT_EQ(answer.code, 0) << answer.error;
  // While the river is highest, which is not at the end.
  EXPECT_NE(answer.text.find(" m3/s per m at t = 2000 s, when least is known of it, between "),
            std::string::npos)
      << answer.text;
  EXPECT_NE(answer.text.find(" % of the largest of the run, "), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("mesh.error = 0.01 is not met: mesh again"), std::string::npos);
  for (const double x : {18.0, 22.0}) {
    EXPECT_LT(size_at("run.h5", x, 6.0), 0.6 * size_at("start.h5", x, 6.0)) << "at x = " << x;
  }
}

/// How well the discharge is to be known, and what is written, changes no run.
TEST_F(MeshAgain, TakesARunThatAskedForAnotherError) {
  run(two_weirs());
  run(test::with(two_weirs(), "looser", {"mesh.error=0.5", "output.every=1000.0"}));
  const Answer answer = ask("looser", "looser.h5", "--from weirs.results");
  EXPECT_EQ(answer.code, 0) << answer.error;
  EXPECT_NE(answer.text.find("mesh.error = 0.5 is met"), std::string::npos) << answer.text;
}

TEST_F(MeshAgain, TakesTheStartWhereTheFlowStays) {
  const test::Mode steady = test::with(two_weirs(), "steady", {"boundary[2].head=8.0"});
  run(steady);
  ASSERT_EQ(ask("steady", "start.h5").code, 0);
  ASSERT_EQ(ask("steady", "run.h5", "--from steady.results").code, 0);
  const std::vector<double> start = read_mesh_sizes<2>(place_.path("start.h5")).size;
  const std::vector<double> run = read_mesh_sizes<2>(place_.path("run.h5")).size;
  ASSERT_EQ(run.size(), start.size());
  for (std::size_t i = 0; i < run.size(); ++i) EXPECT_NEAR(run[i], start[i], 1e-5 * start[i]);
}

TEST_F(MeshAgain, DoesNotDependOnAResumption) {
  run(two_weirs());
  ASSERT_EQ(ask("weirs", "whole.h5", "--from weirs.results").code, 0);
  const std::string stopped = place_.copy(place_.path("weirs.results"), "stopped.results");
  test::stop_after_snapshot(stopped, 1);
  ASSERT_EQ(solver("weirs.case.h5 --quiet --resume -o stopped.results").code, 0);
  ASSERT_EQ(ask("weirs", "resumed.h5", "--from stopped.results").code, 0);
  EXPECT_TRUE(test::read_file(place_.path("whole.h5")) ==
              test::read_file(place_.path("resumed.h5")));
}

TEST_F(MeshAgain, RefusesARunThatSaysNothing) {
  const test::Mode plain = test::with(
      two_weirs(), "plain", {R"(mesh={size = 1.0, structure = "free"})", "time.end=1000.0"});
  run(plain);
  const Answer without = ask("plain", "refused.h5", "--from plain.results");
  EXPECT_EQ(without.code, 2);
  EXPECT_NE(
      without.error.find("--from: got \"plain.results\", whose snapshots have no field error; "
                         "expected a run of a scene with mesh.error"),
      std::string::npos)
      << without.error;
  const test::Mode still = test::with(
      two_weirs(), "still", {"boundary[0].head=6.0", "boundary[2].head=6.0", "time.end=1000.0"});
  run(still);
  const Answer nothing = ask("still", "refused.h5", "--from still.results");
  EXPECT_EQ(nothing.code, 2);
  EXPECT_NE(nothing.error.find("got no flow that heads drive, at any snapshot of the run"),
            std::string::npos)
      << nothing.error;
  EXPECT_EQ(ask("still", "refused.h5").code, 2);
  EXPECT_FALSE(fs::exists(place_.path("refused.h5")));
}

TEST_F(MeshAgain, RefusesTheRunOfAnotherCase) {
  run(two_weirs());
  const test::Mode finer =
      test::with(two_weirs(), "finer", {R"(mesh={size = 0.9, structure = "free", error = 0.01})"});
  run(finer);
  expect_refused("--from finer.results", "got \"finer.results\", the results of another case");
  expect_refused("--from finer.results", "the mesh or the points");
  test::stop_after_snapshot(place_.path("weirs.results"), 1);
  expect_refused("--from weirs.results", "expected a run that is done");
  const Answer none = ask("weirs", "refused.h5", "--from nowhere");
  EXPECT_EQ(none.code, 4) << none.error;
  const Answer alone = solver("weirs.case.h5 --from weirs.results");
  EXPECT_EQ(alone.code, 2);
  EXPECT_NE(alone.error.find("--from requires --sizes"), std::string::npos) << alone.error;
}

TEST_F(MeshAgain, RefusesTheStartOfALaterStage) {
  // The soil at its start is what the earlier run has left, not that of the scene.
  run(test::with(two_weirs(), "earlier", {}));
  static_cast<void>(place_.make_case(
      test::with(two_weirs(), "weirs", {R"(initial={from = "earlier.results"})"})));
  expect_refused("", "initial.from: got \"earlier.results\"; expected none, or --from");
}

TEST_F(MeshAgain, RefusesTheExplicitScheme) {
  const test::Mode is_explicit =
      test::with(two_weirs(), "explicit",
                 {R"(mesh={size = 1.0, structure = "free"})",
                  R"(time={end = 1.0, scheme = "explicit"})", "liquid.bulk_modulus=2e6"});
  static_cast<void>(place_.make_case(is_explicit));
  const Answer answer = ask("explicit", "refused.h5", "--from anything");
  EXPECT_EQ(answer.code, 2);
  EXPECT_NE(answer.error.find("\"implicit\": only its fluxes bound the discharge"),
            std::string::npos)
      << answer.error;
}

}  // namespace mesh_again_test
}  // namespace suffuse
