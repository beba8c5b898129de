/// Runs the tests on all processes, each of which prints its failures. One that fails makes mpirun
/// fail.

#include <gtest/gtest.h>

#include <iostream>
#include <memory>

#include "ranks/mpi_ranks.hpp"

namespace {

/// Prints failures alone, with the rank.
class Failures final : public testing::EmptyTestEventListener {
 public:
  explicit Failures(int rank) : rank_(rank) {}
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (!result.failed()) return;
    std::cout << "rank " << rank_ << ": " << result.file_name() << ':' << result.line_number()
              << ": FAILED: " << result.summary() << '\n';
  }

 private:
  int rank_;
};

}  // namespace

int main(int argc, char** argv) {
  const suffuse::MpiProcess mpi;
  testing::InitGoogleTest(&argc, argv);
  if (const int rank = suffuse::mpi_ranks()->rank(); rank > 0) {
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    const std::unique_ptr<testing::TestEventListener> printer(
        listeners.Release(listeners.default_result_printer()));
    listeners.Append(std::make_unique<Failures>(rank).release());
  }
  return RUN_ALL_TESTS();
}
