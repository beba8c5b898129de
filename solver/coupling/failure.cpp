#include "coupling/failure.hpp"

#include <sstream>

namespace suffuse {
namespace {

/// Shortest step in equilibrium, over the time in which soil falls through an element.
constexpr double short_step = 1e-2;
/// Inertia makes no progress if this many steps together take less than this share of that time:
/// soil that falls through the height of the model takes some 1e-2 of it in each.
constexpr int stuck_steps = 500;
constexpr double stuck_time = 1e-3;
/// Steps in equilibrium make no progress if this many trials have no solution within this share of
/// the time since the start.
constexpr int stuck_trials = 200;
constexpr double stuck_share = 1e-2;

/// Places of the points in the order of their numbers, m.
template <int Dim>
std::vector<Vector<Dim>> places_by_id(const MovingSkeleton<Dim>& solid) {
  std::vector<Vector<Dim>> places(solid.points().size());
  for (int p = 0; p < solid.points().size(); ++p)
    places[solid.id()[p]] = solid.points().position[p];
  return places;
}

}  // namespace

template <int Dim>
void Failure<Dim>::start_inertia(double time) {
  solid_.start_inertia();
  repeated_.fails(places_by_id(solid_), mean_size(grid_.mesh));
  time_ = time;
  rested_ = counted_time_ = 0.0;
  counted_steps_ = unsolved_ = 0;
  is_stuck_ = false;
}

template <int Dim>
bool Failure<Dim>::is_stuck() const {
  return has_inertia() ? is_stuck_ : unsolved_ >= stuck_trials;
}

template <int Dim>
void Failure<Dim>::count_unsolved(double time) {
  if (has_inertia()) return;
  if (time > unsolved_since_ * (1.0 + stuck_share)) {
    unsolved_since_ = time;
    unsolved_ = 0;
  }
  ++unsolved_;
}

template <int Dim>
void Failure<Dim>::start(const StartStress& found) {
  if (found.stands) return;
  if (watches()) return start_inertia(0.0);
  const std::string place =
      found.worst_node < 0 ? "" : ", least " + node_text(grid_, found.worst_node);
  throw NumericalError(
      "the soil has no equilibrium at the start: it cannot carry its weight and the loads at "
      "t = 0 s" +
      place +
      "; give it more strength or stiffness, fix a boundary that it leans on, or let it move "
      "(time.failure = \"follow\")");
}

template <int Dim>
void Failure<Dim>::step_unsolved(double time, const Unsolved& why) {
  if (!watches()) refuse(time, why);
  start_inertia(time);
  long_steps_ = false;
}

template <int Dim>
void Failure<Dim>::finish_step(double time, double next_step, const SoilKinetics& soil) {
  // Soil at rest does not move: short steps then are those of the flow, which follows its errors
  // again after the motion.
  if (solid_.rests()) return expect_short_steps();
  const bool is_short = next_step < short_step * solid_.time_of_fall();
  if (long_steps_ && watches() && (is_short || soil.is_slide())) {
    start_inertia(time);
    long_steps_ = false;
  } else if (!is_short) {
    long_steps_ = true;
  }
}

template <int Dim>
void Failure<Dim>::finish_motion(double duration, const SoilKinetics& soil) {
  rested_ = soil.is_rest() ? rested_ + duration : 0.0;
  if (rested_ > soil.soil.time_of_fall())
    solid_.end_inertia(repeated_.held_share() * soil.load_share);
  counted_time_ += duration;
  if (++counted_steps_ < stuck_steps) return;
  is_stuck_ = counted_time_ < stuck_time * solid_.time_of_fall();
  counted_time_ = 0.0;
  counted_steps_ = 0;
}

template <int Dim>
void Failure<Dim>::refuse(double time, const Unsolved& why) const {
  std::ostringstream message;
  message << "t = " << time << " s: ";
  if (has_inertia()) {
    message << why.text << ": the motion of the soil that fails has no solution";
  } else if (why.no_equilibrium) {
    message << "the soil has lost its equilibrium: it cannot carry its weight, its loads and the "
               "pressure of the water any longer"
            << (why.worst_node < 0 ? "" : ", least " + node_text(grid_, why.worst_node))
            << " (to follow it: time.failure = \"follow\")";
  } else {
    message << why.text;
    if (is_stuck()) {
      message << "; since t = " << unsolved_since_ << " s " << unsolved_
              << " steps have been shortened for want of a solution";
    } else {
      message << ", however short the step is";
    }
    message << ": soil that yields is about to lose its equilibrium";
  }
  throw EquilibriumLost(message.str());
}

template class Failure<2>;
template class Failure<3>;

}  // namespace suffuse
