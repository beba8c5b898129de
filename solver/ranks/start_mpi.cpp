#include "ranks/mpi_ranks.hpp"
#include "ranks/start_ranks.hpp"

namespace suffuse {
namespace {

struct Started {
  MpiProcess process;
  std::shared_ptr<const Ranks> ranks = mpi_ranks();
};

}  // namespace

std::shared_ptr<const Ranks> start_ranks() {
  const auto started = std::make_shared<const Started>();
  return {started, started->ranks.get()};
}

}  // namespace suffuse
