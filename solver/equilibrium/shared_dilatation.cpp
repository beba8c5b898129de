#include "equilibrium/shared_dilatation.hpp"

#include <algorithm>

#include "grid/dilatation_patches.hpp"

namespace suffuse {

template <int Dim>
SharedDilatation<Dim>::SharedDilatation(const Grid<Dim>& grid, const std::vector<double>& weight) {
  if (std::ranges::none_of(weight, [](double w) { return w > 0.0; })) return;
  const std::vector<int> patch = dilatation_patches(grid);
  std::vector<std::vector<int>> elements(patch.size());
  for (std::size_t e = 0; e < patch.size(); ++e) {
    if (weight[e] > 0.0 && patch[e] >= 0) elements[patch[e]].push_back(static_cast<int>(e));
  }
  share_.assign(weight.size(), 0.0);
  for (const std::vector<int>& of_patch : elements) {
    if (of_patch.size() > 1) add_patch(grid.mesh, weight, of_patch);
  }
  if (acts()) tangent_.resize(weight.size());
}

template <int Dim>
void SharedDilatation<Dim>::add_patch(const Mesh<Dim>& mesh, const std::vector<double>& weight,
                                      const std::vector<int>& elements) {
  Patch patch;
  double sum = 0.0;
  for (const int e : elements) {
    sum += weight[e];
    std::array<int, Dim + 1> places;
    for (int a = 0; a <= Dim; ++a) {
      const auto at = std::ranges::find(patch.nodes, mesh.elements[e][a]);
      places[a] = static_cast<int>(at - patch.nodes.begin());
      if (at == patch.nodes.end()) patch.nodes.push_back(mesh.elements[e][a]);
    }
    patch.places.push_back(places);
  }
  for (const int e : elements) share_[e] = weight[e] / sum;
  patch.elements = elements;
  patches_.push_back(std::move(patch));
}

template <int Dim>
void SharedDilatation<Dim>::average(std::vector<double>& ratio) const {
  for (const Patch& patch : patches_) {
    double mean = 0.0;
    for (const int e : patch.elements) mean += share_[e] * ratio[e];
    for (const int e : patch.elements) ratio[e] = mean;
  }
}

template <int Dim>
std::vector<double> SharedDilatation<Dim>::variation(const Mesh<Dim>& mesh,
                                                     const std::vector<Vector<Dim>>& weight) const {
  std::vector<double> result(weight.size(), 0.0);
  for (int d = 0; d < Dim; ++d) {
    std::vector<double> of_patch(weight.size());
    std::vector<double> place(weight.size());
    for (std::size_t e = 0; e < weight.size(); ++e) {
      of_patch[e] = weight[e][d];
      place[e] = element_centroid(mesh, static_cast<int>(e))[d];
    }
    std::vector<double> middle = place;
    average(of_patch);
    average(middle);
    for (std::size_t e = 0; e < weight.size(); ++e) {
      result[e] += of_patch[e] * (place[e] - middle[e]);
    }
  }
  return result;
}

template <int Dim>
std::vector<double> SharedDilatation<Dim>::spread(const std::vector<double>& mean) const {
  std::vector<double> result(mean.size(), 0.0);
  for (const Patch& patch : patches_) {
    double sum = 0.0;
    for (const int e : patch.elements) sum += mean[e];
    for (const int e : patch.elements) result[e] = share_[e] * sum;
  }
  return result;
}

template <int Dim>
std::vector<std::vector<int>> SharedDilatation<Dim>::patch_nodes() const {
  std::vector<std::vector<int>> result;
  result.reserve(patches_.size());
  for (const Patch& patch : patches_) result.push_back(patch.nodes);
  return result;
}

template <int Dim>
void SharedDilatation<Dim>::add_tangent(const DisplacementUnknowns<Dim>& unknowns,
                                        const std::vector<double>& mean_ratio,
                                        const StiffnessPattern<Dim>& pattern,
                                        Eigen::SparseMatrix<double>& matrix) const {
  add(tangent_, unknowns, mean_ratio, pattern, matrix);
}

template <int Dim>
void SharedDilatation<Dim>::add_elastic(const Grid<Dim>& grid,
                                        const DisplacementUnknowns<Dim>& unknowns,
                                        const std::vector<double>& stiffness,
                                        const StiffnessPattern<Dim>& pattern,
                                        Eigen::SparseMatrix<double>& matrix) const {
  if (!acts()) return;
  std::vector<Tangent> elastic(stiffness.size());
  for (std::size_t e = 0; e < elastic.size(); ++e) {
    for (int a = 0; a <= Dim; ++a) elastic[e].of_ratio.col(a) = grid.shape_gradient[e][a];
    elastic[e].of_both = stiffness[e];
  }
  add(elastic, unknowns, std::vector<double>(stiffness.size(), 1.0), pattern, matrix);
}

/// The derivative of a patch's forces is f r^T + r q^T, where r is dtheta/du, f the derivative of
/// the forces by theta, and q that of the sum of the mean stresses by u.
template <int Dim>
void SharedDilatation<Dim>::add(const std::vector<Tangent>& tangent,
                                const DisplacementUnknowns<Dim>& unknowns,
                                const std::vector<double>& mean_ratio,
                                const StiffnessPattern<Dim>& pattern,
                                Eigen::SparseMatrix<double>& matrix) const {
  Eigen::MatrixXd vectors;  // r, f, q
  for (std::size_t number = 0; number < patches_.size(); ++number) {
    const Patch& patch = patches_[number];
    vectors.setZero(Dim * static_cast<Eigen::Index>(patch.nodes.size()), 3);
    double both = 0.0;
    const double ratio = mean_ratio[patch.elements.front()];
    for (std::size_t k = 0; k < patch.elements.size(); ++k) {
      const int e = patch.elements[k];
      for (int a = 0; a <= Dim; ++a) {
        auto at = vectors.middleRows<Dim>(Dim * patch.places[k][a]);
        at.col(0) += share_[e] / ratio * tangent[e].of_ratio.col(a);
        at.col(1) += tangent[e].of_forces.col(a);
        at.col(2) += tangent[e].of_mean.col(a);
      }
      both += tangent[e].of_both;
    }
    vectors.col(2) += both * vectors.col(0);
    int count = 0;
    for (std::size_t at = 0; at < patch.nodes.size(); ++at) {
      const int i = patch.nodes[at];
      const Eigen::Matrix<double, Dim, 3> along =
          unknowns.supports().directions(i).transpose() * vectors.middleRows<Dim>(Dim * at);
      for (int k = 0; k < unknowns.count(i); ++k) vectors.row(count++) = along.row(k);
    }
    auto slot = pattern.of_patch(number).begin();
    for (int column = 0; column < count; ++column) {
      for (int row = 0; row < count; ++row) {
        matrix.valuePtr()[*slot++] +=
            vectors(row, 1) * vectors(column, 0) + vectors(row, 0) * vectors(column, 2);
      }
    }
  }
}

template class SharedDilatation<2>;
template class SharedDilatation<3>;

}  // namespace suffuse
