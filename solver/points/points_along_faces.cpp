#include "points/points_along_faces.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "common/errors.hpp"
#include "physics/liquid.hpp"

namespace suffuse {
namespace {

/// Elements that a point may cross in one step. In steady flow the result does not depend on the
/// step, because fines are taken up along the path; in unsteady flow points follow the mean of the
/// step.
constexpr double max_elements = 1.0;
/// Points that one thread moves at a time.
constexpr int points_together = 1024;

}  // namespace

template <int Dim>
PointsAlongFaces<Dim>::PointsAlongFaces(const Grid<Dim>& grid, const Skeleton<Dim>& solid,
                                        const std::vector<FaceCondition>& conditions,
                                        InjectionSettings injection, LiquidDensities densities,
                                        double bulk_modulus, int threads,
                                        const MaterialPoints<Dim>& places,
                                        const std::vector<double>& pressure)
    : PointTransport<Dim>(grid, solid, conditions, std::move(injection), densities, bulk_modulus,
                          threads),
      points_(clean_liquid(places, pressure, densities, bulk_modulus)) {
  const long before = grid.ranks().before(points_.size());
  for (long& id : points_.id) id += before;
  note_points();
  this->inflow_ = this->injection_.initial_account(all_points_);
}

template <int Dim>
void PointsAlongFaces<Dim>::note_points() {
  begins_ = element_begins(points_, this->grid_.mesh.element_count());
  all_points_ = static_cast<long>(sum_of_all(this->grid_.ranks(), points_.size()));
}

template <int Dim>
void PointsAlongFaces<Dim>::archive(StateArchive& archive) {
  PointTransport<Dim>::archive(archive);
  LiquidPoints<Dim> whole;
  if (!archive.restores()) whole = points_;
  this->shared_.number_elements(whole);
  archive(in_parts(whole.element), in_parts(whole.barycentric), in_parts(whole.water_mass),
          in_parts(whole.fines_mass), in_parts(whole.id), in_parts(whole.pressure),
          in_parts(whole.velocity));
  if (!archive.restores()) return;
  this->shared_.take_own(whole);
  points_ = std::move(whole);
  note_points();
}

template <int Dim>
LiquidContent PointsAlongFaces<Dim>::content() const {
  const auto elements = static_cast<std::size_t>(this->grid_.mesh.element_count());
  LiquidContent content{std::vector<double>(elements, 0.0), std::vector<double>(elements, 0.0)};
  for (int p = 0; p < points_.size(); ++p) {
    content.fines[points_.element[p]] += points_.fines_mass[p] / this->densities_.grain;
    content.liquid[points_.element[p]] +=
        liquid_volume(points_.water_mass[p], points_.fines_mass[p], this->densities_, 1.0);
  }
  this->grid_.element_rows().exchange(content.fines);
  this->grid_.element_rows().exchange(content.liquid);
  return content;
}

template <int Dim>
std::vector<double> PointsAlongFaces<Dim>::point_volume(const LiquidPoints<Dim>& points,
                                                        const std::vector<double>& pressure) const {
  std::vector<double> result(points.size());
  int ratio_of = -1;
  double ratio = 1.0;
  for (int p = 0; p < points.size(); ++p) {
    if (points.element[p] != ratio_of) {
      ratio_of = points.element[p];
      ratio = density_ratio(pressure[ratio_of], this->bulk_modulus_);
    }
    result[p] = liquid_volume(points.water_mass[p], points.fines_mass[p], this->densities_, ratio);
  }
  return result;
}

template <int Dim>
std::vector<double> PointsAlongFaces<Dim>::point_pressure(const LiquidPoints<Dim>& points,
                                                          const FlowState<Dim>& flow) const {
  std::vector<double> result(points.size());
  for (int p = 0; p < points.size(); ++p) {
    result[p] = interpolate(this->grid_, points.place(p), flow.node_pressure);
  }
  return result;
}

template <int Dim>
double PointsAlongFaces<Dim>::longest_step(const std::vector<double>& face_rate) const {
  const std::vector<double> porosity = this->solid_.element_porosity();
  double most = 0.0;
  for (int e = 0; e < this->grid_.mesh.element_count(); ++e) {
    most = std::max(most, crossings(this->grid_, {face_rate, porosity, porosity}, e));
  }
  most = largest_of_all(this->grid_.ranks(), most);
  return most > 0.0 ? transport_safety * max_elements / most
                    : std::numeric_limits<double>::infinity();
}

template <int Dim>
void PointsAlongFaces<Dim>::start_interval(const FlowProgress& flow) {
  this->start_crossings();
  porosity_ = this->solid_.element_porosity();
  if (this->solid_.moves()) {
    solid_porosity_ = porosity_;
    opening_ = flow.room_gained;
    for (std::size_t e = 0; e < opening_.size(); ++e) {
      opening_[e] /= this->grid_.volume[e];
      porosity_[e] -= opening_[e];
    }
  }
}

template <int Dim>
std::vector<double> PointsAlongFaces<Dim>::porosity_after(double share, bool exchanges) {
  std::vector<double> now = exchanges ? this->solid_.element_porosity() : porosity_;
  if (opening_.empty()) return now;
  if (!exchanges) now = solid_porosity_;
  exchanged_.resize(now.size());
  std::vector<double> result = porosity_;
  for (std::size_t e = 0; e < now.size(); ++e) {
    exchanged_[e] = now[e] - solid_porosity_[e];
    result[e] += exchanged_[e] + share * opening_[e];
  }
  solid_porosity_ = std::move(now);
  return result;
}

template <int Dim>
void PointsAlongFaces<Dim>::advance(const TransportStep& step, const FaceVolumes& volumes,
                                    const std::vector<double>& eroded,
                                    const std::vector<double>& pressure) {
  std::vector<double> volume = volumes.liquid;
  for (double& v : volume) v *= step.share;
  const bool erodes = any_of_all(this->grid_.ranks(), !eroded.empty());
  std::vector<double> porosity_end = porosity_after(step.share, erodes);
  if (this->deposition_.active()) this->deposition_.start(step.end - step.start);
  if (erodes) mean_fines_ = mean_fines();
  Paths paths;
  {
    const PassTimer timer(this->movement_timing_);
    ++this->movement_timing_.calls;
    paths = follow(volume, porosity_end, pressure);
  }
  if (erodes || this->has_pending()) {
    const PassTimer timer(this->fines_timing_);
    ++this->fines_timing_.calls;
    this->book(this->transfer_.transfer_along_paths(eroded, point_volume(points_, pressure),
                                                    points_, paths.uptakes, this->pending_));
  }
  if (this->deposition_.active()) {
    const PassTimer timer(this->fines_timing_);
    this->deposition_.leave_along_paths(paths.fines, paths.uptakes, points_);
    this->book_deposition();
  }
  const PassTimer timer(this->movement_timing_);
  settle(paths);
  this->empty_total_ += this->empty_elements();
  porosity_ = std::move(porosity_end);
}

template <int Dim>
void PointsAlongFaces<Dim>::follow_deposits() {
  // Otherwise the next step would treat deposits as pores that close while points pass, and take
  // their fines from the points again.
  std::vector<double> now = this->solid_.element_porosity();
  if (opening_.empty()) {
    porosity_ = std::move(now);
    return;
  }
  for (std::size_t e = 0; e < now.size(); ++e) porosity_[e] += now[e] - solid_porosity_[e];
  solid_porosity_ = std::move(now);
}

template <int Dim>
void PointsAlongFaces<Dim>::inject(const std::vector<double>& volume,
                                   const std::vector<double>& pressure, Paths& paths,
                                   std::vector<double>& start) {
  std::vector<InjectedPoint<Dim>> injected;
  together(this->grid_.ranks(),
           [&] { this->injection_.inject(this->inflow_, volume, {}, injected); });
  const auto places = this->injection_.places(injected);
  auto place = places.of_point.begin();
  for (const InjectedPoint<Dim>& point : injected) {
    const int e = point.place.element;
    const auto [water_mass, fines_mass] = this->injection_.content(point, pressure[e]);
    points_.element.push_back(e);
    points_.barycentric.push_back(point.place.barycentric);
    points_.water_mass.push_back(water_mass);
    points_.fines_mass.push_back(fines_mass);
    points_.id.push_back(this->inflow_.next_id + *place);
    this->shared_.add_injected(*place++);
    paths.from.push_back(-1);
    paths.entered_by.push_back(point.face);
    start.push_back(point.share);
  }
  this->inflow_.next_id += places.count;
}

template <int Dim>
auto PointsAlongFaces<Dim>::follow(const std::vector<double>& volume,
                                   const std::vector<double>& porosity_end,
                                   const std::vector<double>& pressure) -> Paths {
  Paths paths;
  paths.from.reserve(points_.element.size());
  for (const int e : points_.element) {
    paths.from.push_back(this->grid_.mesh.element_region[e]);
  }
  std::vector<double> start(points_.element.size(), 0.0);
  this->shared_.start_step(points_, begins_);
  inject(volume, pressure, paths, start);
  paths.fines = points_.fines_mass;

  const FaceWalkField<Dim> field{volume, porosity_, porosity_end, this->deposition_.active(),
                                 opening_.empty() ? nullptr : &exchanged_};
  const int count = points_.size();
  paths.left_by.assign(count, -1);
  // One list for each block of points, so that the order does not depend on threads.
  const int blocks = (count + points_together - 1) / points_together;
  std::vector<std::vector<FinesUptake<Dim>>> uptakes(blocks);
  std::exception_ptr failure;
#pragma omp parallel for schedule(dynamic) num_threads(this->threads_) if (blocks > 4)
  for (int block = 0; block < blocks; ++block) {
    try {
      std::vector<FacePassage<Dim>> passages;
      const int end = std::min(count, (block + 1) * points_together);
      for (int p = block * points_together; p < end; ++p) {
        follow_point(p, start[p], field, pressure[points_.element[p]], passages, paths,
                     uptakes[block]);
      }
    } catch (...) {
#pragma omp critical(suffuse_follow_failure)
      failure = std::current_exception();
    }
  }
  together(this->grid_.ranks(), [&] {
    if (failure) std::rethrow_exception(failure);
  });
  std::size_t all = 0;
  for (const auto& of_block : uptakes) all += of_block.size();
  paths.uptakes.reserve(all);
  for (auto& of_block : uptakes) {
    paths.uptakes.insert(paths.uptakes.end(), of_block.begin(), of_block.end());
    of_block = {};  // frees memory of what was copied
  }
  return paths;
}

template <int Dim>
double PointsAlongFaces<Dim>::weight(int element, int p) const {
  if (mean_fines_.empty() || !(mean_fines_[element] > 0.0)) return 1.0;
  const ErosionModel& erosion = this->solid_.soils().erosion_of_element(element);
  const bool by_fines = erosion.law != nullptr && erosion.law->depends_on_concentration;
  if (!by_fines) return 1.0;
  return points_.fines_mass[p] / points_.water_mass[p] / mean_fines_[element];
}

template <int Dim>
std::vector<double> PointsAlongFaces<Dim>::mean_fines() const {
  if (!this->solid_.soils().exchange_depends_on().concentration) return {};
  std::vector<double> fines(this->grid_.mesh.elements.size(), 0.0);
  std::vector<double> water(fines.size(), 0.0);
  for (int p = 0; p < points_.size(); ++p) {
    fines[points_.element[p]] += points_.fines_mass[p];
    water[points_.element[p]] += points_.water_mass[p];
  }
  for (std::size_t e = 0; e < fines.size(); ++e) {
    if (water[e] > 0.0) fines[e] /= water[e];
  }
  this->grid_.element_rows().exchange(fines);
  return fines;
}

template <int Dim>
void PointsAlongFaces<Dim>::follow_point(int p, double start, const FaceWalkField<Dim>& field,
                                         double pressure, std::vector<FacePassage<Dim>>& passages,
                                         Paths& paths, std::vector<FinesUptake<Dim>>& uptakes) {
  const auto& region = this->grid_.mesh.element_region;
  double volume = liquid_volume(points_.water_mass[p], points_.fines_mass[p], this->densities_,
                                density_ratio(pressure, this->bulk_modulus_));
  PointPlace<Dim> place = points_.place(p);
  passages.clear();
  paths.left_by[p] =
      walk_along_faces(this->grid_, field, place, start, 1.0, points_.id[p], passages);
  const int face = paths.left_by[p];
  if (face >= 0 && this->grid_.ranks().count() > 1 && !this->grid_.is_border(face)) {
    throw NumericalError(
        "a liquid point crosses more than two elements in one step, which cannot be followed on "
        "several ranks; take a smaller time.step, or one process: suffuse-solver");
  }
  points_.element[p] = place.element;
  points_.barycentric[p] = place.barycentric;
  for (const FacePassage<Dim>& passage : passages) {
    const bool in_first = region[passage.element] == paths.from[p];
    const double own = volume * (passage.growth - 1.0);
    uptakes.push_back({p, passage.element, passage.barycentric, own * weight(passage.element, p),
                       in_first ? paths.from[p] : region[place.element],
                       this->deposition_.active() ? this->deposition_.exponent(passage) : 0.0});
    volume *= passage.growth;
  }
}

template <int Dim>
void PointsAlongFaces<Dim>::settle(const Paths& paths) {
  const auto& region = this->grid_.mesh.element_region;
  const int count = points_.size();
  std::vector<double> carried = paths.fines;
  for (const FinesUptake<Dim>& uptake : paths.uptakes) {
    if (uptake.region == paths.from[uptake.point]) carried[uptake.point] += uptake.mass;
  }
  auto& crossings = this->crossings_.points;
  const int first_injected = count - static_cast<int>(paths.entered_by.size());
  std::vector<unsigned char> keep(count, 1);
  for (int p = 0; p < count; ++p) {
    const int last = region[points_.element[p]];
    if (paths.from[p] != last) {
      const int face = p < first_injected ? -1 : paths.entered_by[p - first_injected];
      crossings.push_back({paths.from[p], last, face, -1, points_.water_mass[p], carried[p]});
    }
    if (paths.left_by[p] < 0) continue;
    keep[p] = 0;
    crossings.push_back(
        {last, -1, -1, paths.left_by[p], points_.water_mass[p], points_.fines_mass[p]});
  }
  book_outflow(paths);
  this->shared_.settle(points_, std::move(keep));
  note_points();
}

template <int Dim>
void PointsAlongFaces<Dim>::book_outflow(const Paths& paths) {
  const Grid<Dim>& grid = this->grid_;
  const bool leaves = std::ranges::any_of(paths.left_by, [](int face) { return face >= 0; });
  if (!any_of_all(grid.ranks(), leaves)) return;
  const auto by_side = this->shared_.template sums<Dim + 1>([&](const auto& add) {
    for (int p = 0; p < points_.size(); ++p) {
      if (paths.left_by[p] < 0) continue;
      const int e = points_.element[p];
      std::array<double, Dim + 1> volume{};
      volume[grid.side_of(e, paths.left_by[p])] =
          liquid_volume(points_.water_mass[p], points_.fines_mass[p], this->densities_, 1.0);
      add(e, p, volume);
    }
  });
  for (const int f : this->injection_.open_faces()) {
    const int e = grid.face_left[f];
    this->inflow_.volume[f] += by_side[e][grid.side_of(e, f)];
  }
}

template class PointsAlongFaces<2>;
template class PointsAlongFaces<3>;

}  // namespace suffuse
