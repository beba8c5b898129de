#include "coupling/repeated_failure.hpp"

#include <algorithm>
#include <cmath>

namespace suffuse {

template <int Dim>
void RepeatedFailure<Dim>::fails(const std::vector<Vector<Dim>>& position, double size) {
  double farthest = 0.0;
  for (std::size_t p = 0; p < place_.size(); ++p) {
    farthest = std::max(farthest, (position[p] - place_[p]).norm());
  }
  if (count_ > 0 && farthest < way * size * count_) {
    ++count_;
    return;
  }
  place_ = position;
  count_ = 1;
}

template <int Dim>
double RepeatedFailure<Dim>::held_share() const {
  return std::min(1.0, std::ldexp(first_share, count_ - 1));
}

template class RepeatedFailure<2>;
template class RepeatedFailure<3>;

}  // namespace suffuse
