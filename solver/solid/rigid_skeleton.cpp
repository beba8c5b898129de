#include "solid/rigid_skeleton.hpp"

#include "grid/parallel.hpp"
#include "solid/pores.hpp"

namespace suffuse {

template <int Dim>
RigidSkeleton<Dim>::RigidSkeleton(const Grid<Dim>& grid, const SoilMap<Dim>& soils,
                                  const TimeSpan& span, int threads)
    : ErodingSkeleton<Dim>(grid, soils, span, threads) {
  for (const ElementValues<Dim>& pores : initial_pore_volume(grid, soils)) {
    initial_pores_.push_back(element_sum<Dim>(pores));
  }
}

template <int Dim>
std::vector<double> RigidSkeleton<Dim>::element_porosity() const {
  // Use the gains of points: the initial porosity is linear in space, and its mean at a few points
  // need not be the mean of the element.
  const SoilMap<Dim>& soils = this->soils();
  const MaterialPoints<Dim>& points = soils.points();
  const Grid<Dim>& grid = this->grid_;
  std::vector<double> result(grid.mesh.element_count());
  for_each_index(grid.mesh.element_count(), this->threads_, [&](int e) {
    double pores = initial_pores_[e];
    for (int p = soils.points_begin(e); p < soils.points_begin(e + 1); ++p) {
      pores += points.volume[p] * (this->porosity_[p] - this->initial_porosity_[p]);
    }
    result[e] = pores / grid.volume[e];
  });
  return result;
}

template <int Dim>
void RigidSkeleton<Dim>::archive(StateArchive& archive) {
  ErodingSkeleton<Dim>::archive(archive);
  if (archive.restores()) this->update_porosity();
}

template class RigidSkeleton<2>;
template class RigidSkeleton<3>;

}  // namespace suffuse
