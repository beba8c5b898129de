#include "ranks/start_ranks.hpp"

namespace suffuse {

std::shared_ptr<const Ranks> start_ranks() {
  return std::make_shared<Ranks>();
}

}  // namespace suffuse
