#include "coupling/repeated_failure.hpp"

#include <sstream>

#include "solid/skeleton.hpp"

namespace suffuse {

template <int Dim>
int RepeatedFailure<Dim>::farthest(const std::vector<Vector<Dim>>& position) const {
  int result = 0;
  double most_moved = 0.0;
  for (std::size_t p = 0; p < position.size(); ++p) {
    const double moved = (position[p] - place_[p]).squaredNorm();
    if (!(moved > most_moved)) continue;
    most_moved = moved;
    result = static_cast<int>(p);
  }
  return result;
}

template <int Dim>
void RepeatedFailure<Dim>::fails(double time, const std::vector<Vector<Dim>>& position,
                                 double size) {
  bool again = count_ > 0 && time <= stands_from_;
  if (again) {
    const int p = farthest(position);
    again = (position[p] - place_[p]).norm() < way * size * count_;
  }
  if (again) {
    ++count_;
    return;
  }
  place_ = position;
  first_ = time;
  count_ = 1;
}

template <int Dim>
void RepeatedFailure<Dim>::refuse_creep(double time,
                                        const std::vector<Vector<Dim>>& position) const {
  const int p = farthest(position);
  std::ostringstream message;
  message.precision(6);
  message << "t = " << time << " s: the soil creeps and does not come to rest: since t = " << first_
          << " s it has lost its equilibrium " << count_
          << " times, each time as soon as it lay still, and has moved by ";
  message.precision(2);
  message << (position[p] - place_[p]).norm() << " m at most meanwhile, at (";
  message.precision(4);
  for (int d = 0; d < Dim; ++d) message << (d > 0 ? ", " : "") << position[p][d];
  message << ") m. Its strength is just used up there. Expected is soil that stands or slides: a "
             "little more or less strength (soil.NAME.skeleton.cohesion, friction), another "
             "mesh.size, or time.end before this time";
  throw EquilibriumLost(message.str());
}

template class RepeatedFailure<2>;
template class RepeatedFailure<3>;

}  // namespace suffuse
