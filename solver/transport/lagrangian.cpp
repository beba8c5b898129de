#include "transport/lagrangian.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <sstream>
#include <tuple>

#include "case/errors.hpp"
#include "physics/liquid.hpp"

namespace suffuse {
namespace {

/// Fractional part of multiples of it spread evenly (golden ratio - 1).
constexpr double golden = 0.6180339887498948482;
/// A point may cross so much of an element in one step of erosion and transport.
constexpr double most_of_an_element = 0.25;
/// The same where it follows face volumes. Grains are taken on the way there, and in steady flow
/// the answer does not depend on the step, beyond two elements either; but where the flow changes,
/// points follow its mean over the step.
constexpr double most_elements_along_faces = 1.0;
/// Points born at one face in one step. A flow that asks for more has lost its numbers.
constexpr double most_born = 1e7;
/// Points that one thread walks at a time.
constexpr int walked_together = 1024;

double fraction(double x) {
  return x - std::floor(x);
}

/// Uniform in [0, 1), from whole numbers alone (splitmix64): the same on every platform, and born
/// points do not depend on the order in which they are born.
double hashed(std::uint64_t seed, std::uint64_t face, std::uint64_t number, std::uint64_t use) {
  std::uint64_t x = seed;
  for (const std::uint64_t word : {face, number, use}) {
    x += 0x9e3779b97f4a7c15U + word;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    x ^= x >> 31U;
  }
  return static_cast<double>(x >> 11U) * 0x1.0p-53;
}

/// Van der Corput's sequence in base two: each number falls into the widest gap so far.
double radical_inverse(long number) {
  double result = 0.0;
  double digit = 0.5;
  for (long n = number; n > 0; n /= 2, digit *= 0.5) {
    if (n % 2 != 0) result += digit;
  }
  return result;
}

/// Where along a segment the share `u` of a flux has passed that is linear from `at_begin` to
/// `at_end`, both >= 0.
double share_along(double at_begin, double at_end, double u) {
  const double root = std::sqrt(at_begin * at_begin * (1.0 - u) + at_end * at_end * u);
  const double sum = at_begin + root;
  return sum > 0.0 ? u * (at_begin + at_end) / sum : u;
}

}  // namespace

template <int Dim>
LagrangianTransport<Dim>::LagrangianTransport(const Grid<Dim>& grid,
                                              const std::vector<FaceCondition>& conditions,
                                              InjectionSettings births, LiquidDensities densities,
                                              double bulk_modulus, int threads)
    : grid_(grid),
      conditions_(conditions),
      births_(std::move(births)),
      densities_(densities),
      bulk_modulus_(bulk_modulus),
      threads_(threads) {
  for (const FaceCondition& condition : conditions) {
    open_face_.push_back(condition.kind != FaceKind::interior && condition.kind != FaceKind::wall);
    if (open_face_.back() != 0) open_faces_.push_back(static_cast<int>(open_face_.size()) - 1);
  }
}

template <int Dim>
InflowAccount LagrangianTransport<Dim>::nothing_entered(long next_id) const {
  InflowAccount entering;
  entering.next_id = next_id;
  entering.born.assign(grid_.face_count(), 0);
  entering.volume.assign(grid_.face_count(), 0.0);
  for (const int f : open_faces_) {
    entering.volume[f] = births_.point_volume[f] * fraction(0.5 + golden * static_cast<double>(f));
  }
  return entering;
}

template <int Dim>
double LagrangianTransport<Dim>::share_allowed(const LiquidMotion<Dim>& motion,
                                               const std::vector<double>& porosity) const {
  constexpr double any = std::numeric_limits<double>::infinity();
  if (motion.along_faces()) {
    double most = 0.0;
    for (int e = 0; e < grid_.mesh.element_count(); ++e) {
      most = std::max(most, crossings(grid_, {motion.entered, porosity, porosity}, e));
    }
    return most > 0.0 ? most_elements_along_faces / most : any;
  }
  double fastest = 0.0;
  const WalkField<Dim> here = field(motion, porosity);
  for (int e = 0; e < grid_.mesh.element_count(); ++e) {
    fastest = std::max(fastest, crossing_rate(grid_, here, e));
  }
  return fastest > 0.0 ? most_of_an_element / (fastest * motion.duration) : any;
}

template <int Dim>
PointPlace<Dim> LagrangianTransport<Dim>::place_on_face(int face, long number,
                                                        const LiquidMotion<Dim>& motion) const {
  static_assert(Dim == 2, "a face of three nodes needs a share of the flux in two directions");
  // As much of the face's inflow on either side of the point as its number says.
  const auto& nodes = grid_.face_nodes[face];
  const auto inward = [&](int i) {
    if (motion.along_faces()) return 1.0;  // the same all along the face
    return std::max(0.0, -grid_.face_normal[face].dot(motion.node_flux[i]));
  };
  const double u = births_.random
                       ? hashed(births_.seed, face, number, 1)
                       : fraction(radical_inverse(number + 1) + golden * static_cast<double>(face));
  const double s = share_along(inward(nodes[0]), inward(nodes[1]), u);
  const int e = grid_.face_left[face];
  PointPlace<Dim> place{e, {}};
  for (int a = 0; a <= Dim; ++a) {
    const int node = grid_.mesh.elements[e][a];
    if (node == nodes[0]) place.barycentric[a] = 1.0 - s;
    if (node == nodes[1]) place.barycentric[a] = s;
  }
  return place;
}

template <int Dim>
double LagrangianTransport<Dim>::volumes_at_birth(int face, long number) const {
  if (!births_.random) return static_cast<double>(number) + 1.0;
  const long batch = births_.points_per_element[face];
  const long first = number / batch * batch;
  // Asked at every open face in every step: no memory of its own each time.
  thread_local std::vector<double> at;
  at.resize(batch);
  for (long k = 0; k < batch; ++k) {
    at[k] = static_cast<double>(batch) * hashed(births_.seed, face, first + k, 0);
  }
  std::nth_element(at.begin(), at.begin() + (number - first), at.end());
  return static_cast<double>(first) + at[number - first];
}

template <int Dim>
void LagrangianTransport<Dim>::births(InflowAccount& entering, const LiquidMotion<Dim>& motion,
                                      std::vector<InjectedPoint<Dim>>& born) const {
  for (const int f : open_faces_) {
    const double inflow = -motion.entered[f];
    const double before = entering.volume[f];
    entering.volume[f] += inflow;
    if (inflow <= 0.0) continue;
    const double volume = births_.point_volume[f];
    if (!(inflow <= most_born * volume)) {
      const Vector<Dim> at = grid_.face_centre(f);
      std::ostringstream message;
      message << inflow << " m3 enter in one step at (" << at[0];
      for (int d = 1; d < Dim; ++d) message << ", " << at[d];
      message << "), more than " << most_born
              << " liquid points hold; look at the boundary conditions and at gravity";
      throw NumericalError(message.str());
    }
    const long born_before = entering.born[f];
    for (;;) {
      const long number = entering.born[f];
      // In points' volumes, counted as `before` and `entering.volume` are: less those born.
      const double due = volumes_at_birth(f, number) - static_cast<double>(born_before);
      const double share = (due * volume - before) / inflow;
      if (share > 1.0) break;
      born.push_back({place_on_face(f, number, motion), f, number, std::max(0.0, share)});
      entering.volume[f] -= volume;
      ++entering.born[f];
    }
  }
  std::ranges::sort(born, {}, [](const InjectedPoint<Dim>& newborn) {
    return std::tuple(newborn.share, newborn.face, newborn.number);
  });
}

template <int Dim>
auto LagrangianTransport<Dim>::content(const InjectedPoint<Dim>& newborn,
                                       double element_pressure) const -> Content {
  const double concentration = conditions_[newborn.face].concentration;
  const double volume = births_.point_volume[newborn.face];
  const double ratio = density_ratio(element_pressure, bulk_modulus_);
  return {(1.0 - concentration) * volume * densities_.water * ratio,
          concentration * volume * densities_.grain};
}

template <int Dim>
void LagrangianTransport<Dim>::admit(LiquidPoints<Dim>& points, InflowAccount& entering,
                                     const InjectedPoint<Dim>& newborn,
                                     const std::vector<double>& element_pressure) const {
  const int e = newborn.place.element;
  const Content carried = content(newborn, element_pressure[e]);
  points.element.push_back(e);
  points.barycentric.push_back(newborn.place.barycentric);
  points.water_mass.push_back(carried.water_mass);
  points.fines_mass.push_back(carried.fines_mass);
  points.id.push_back(entering.next_id++);
}

template <int Dim>
std::vector<PointCrossing> LagrangianTransport<Dim>::move(
    LiquidPoints<Dim>& points, InflowAccount& entering, const LiquidMotion<Dim>& motion,
    const std::vector<double>& porosity, const std::vector<double>& element_pressure,
    const std::vector<Vector<Dim>>& node_velocity) const {
  std::vector<PointCrossing> crossings;
  const auto& region = grid_.mesh.element_region;
  const int old_points = points.size();
  std::vector<int> from(old_points);
  for (int p = 0; p < old_points; ++p) from[p] = region[points.element[p]];
  std::vector<double> walk_time(old_points, motion.duration);

  std::vector<InjectedPoint<Dim>> born;
  births(entering, motion, born);
  for (const InjectedPoint<Dim>& newborn : born) {
    admit(points, entering, newborn, element_pressure);
    if (!node_velocity.empty()) {
      const int e = newborn.place.element;
      Vector<Dim> velocity = Vector<Dim>::Zero();
      for (int a = 0; a <= Dim; ++a) {
        velocity += newborn.place.barycentric[a] * node_velocity[grid_.mesh.elements[e][a]];
      }
      points.pressure.push_back(element_pressure[e]);
      points.velocity.push_back(velocity);
    }
    from.push_back(-1);
    walk_time.push_back((1.0 - newborn.share) * motion.duration);
  }

  const WalkField<Dim> here = field(motion, porosity);
  const int count = points.size();
  std::vector<int> left_by(count, -1);
  std::exception_ptr failure;
#pragma omp parallel for schedule(static) num_threads(threads_) if (count > 4096)
  for (int p = 0; p < count; ++p) {
    try {
      PointPlace<Dim> place = points.place(p);
      left_by[p] = walk(grid_, here, place, walk_time[p], points.id[p]);
      points.element[p] = place.element;
      points.barycentric[p] = place.barycentric;
    } catch (...) {
#pragma omp critical(suffuse_walk_failure)
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);

  std::vector<unsigned char> keep(count, 1);
  for (int p = 0; p < count; ++p) {
    const bool left = left_by[p] >= 0;
    const int to = left ? -1 : region[points.element[p]];
    if (left) {
      keep[p] = 0;
      entering.volume[left_by[p]] +=
          liquid_volume(points.water_mass[p], points.fines_mass[p], densities_, 1.0);
    }
    if (from[p] != to || left) {
      // A point that enters and leaves at once counts in both directions.
      crossings.push_back({from[p], to, points.water_mass[p], points.fines_mass[p]});
    }
  }
  keep_points(points, keep);
  sort_by_element(points, grid_.mesh.element_count());
  return crossings;
}

template <int Dim>
WalkedPoints<Dim> LagrangianTransport<Dim>::follow(
    LiquidPoints<Dim>& points, InflowAccount& entering, const LiquidMotion<Dim>& motion,
    const std::vector<double>& porosity_begin, const std::vector<double>& porosity_end,
    const std::vector<double>& element_pressure) const {
  WalkedPoints<Dim> walked;
  const auto& region = grid_.mesh.element_region;
  walked.from.reserve(points.element.size());
  for (const int e : points.element) walked.from.push_back(region[e]);
  std::vector<double> begin(points.size(), 0.0);
  std::vector<InjectedPoint<Dim>> born;
  births(entering, motion, born);
  for (const InjectedPoint<Dim>& newborn : born) {
    admit(points, entering, newborn, element_pressure);
    walked.from.push_back(-1);
    begin.push_back(newborn.share);
  }
  walked.grains = points.fines_mass;

  const FaceWalkField<Dim> field{motion.entered, porosity_begin, porosity_end};
  const int count = points.size();
  walked.left_by.assign(count, -1);
  // One list for each block of points: their order does not depend on the threads.
  const int blocks = (count + walked_together - 1) / walked_together;
  std::vector<std::vector<FinesUptake<Dim>>> takes(blocks);
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic) num_threads(threads_) if (blocks > 4)
  for (int block = 0; block < blocks; ++block) {
    try {
      std::vector<FacePassage<Dim>> passages;
      const int end = std::min(count, (block + 1) * walked_together);
      for (int p = block * walked_together; p < end; ++p) {
        double volume =
            liquid_volume(points.water_mass[p], points.fines_mass[p], densities_,
                          density_ratio(element_pressure[points.element[p]], bulk_modulus_));
        PointPlace<Dim> place = points.place(p);
        passages.clear();
        walked.left_by[p] =
            walk_along_faces(grid_, field, place, begin[p], 1.0, points.id[p], passages);
        points.element[p] = place.element;
        points.barycentric[p] = place.barycentric;
        const int last = region[place.element];
        for (const FacePassage<Dim>& passage : passages) {
          const bool in_first = region[passage.element] == walked.from[p];
          takes[block].push_back({p, passage.element, passage.barycentric,
                                  volume * (passage.growth - 1.0),
                                  in_first ? walked.from[p] : last});
          volume *= passage.growth;
        }
      }
    } catch (...) {
#pragma omp critical(suffuse_walk_failure)
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
  std::size_t all = 0;
  for (const auto& of_block : takes) all += of_block.size();
  walked.takes.reserve(all);
  for (auto& of_block : takes) {
    walked.takes.insert(walked.takes.end(), of_block.begin(), of_block.end());
    of_block = {};  // or there would be twice as many
  }
  return walked;
}

template <int Dim>
std::vector<PointCrossing> LagrangianTransport<Dim>::settle(LiquidPoints<Dim>& points,
                                                            InflowAccount& entering,
                                                            const WalkedPoints<Dim>& walked) const {
  const auto& region = grid_.mesh.element_region;
  const int count = points.size();
  std::vector<double> carried = walked.grains;
  for (const FinesUptake<Dim>& take : walked.takes) {
    if (take.region == walked.from[take.point]) carried[take.point] += take.mass;
  }
  std::vector<PointCrossing> crossings;
  std::vector<unsigned char> keep(count, 1);
  for (int p = 0; p < count; ++p) {
    const int last = region[points.element[p]];
    if (walked.from[p] != last) {
      crossings.push_back({walked.from[p], last, points.water_mass[p], carried[p]});
    }
    if (walked.left_by[p] < 0) continue;
    keep[p] = 0;
    crossings.push_back({last, -1, points.water_mass[p], points.fines_mass[p]});
    entering.volume[walked.left_by[p]] +=
        liquid_volume(points.water_mass[p], points.fines_mass[p], densities_, 1.0);
  }
  keep_points(points, keep);
  sort_by_element(points, grid_.mesh.element_count());
  return crossings;
}

template class LagrangianTransport<2>;

}  // namespace suffuse
