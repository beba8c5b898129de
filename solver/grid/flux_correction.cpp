#include "grid/flux_correction.hpp"

#include <algorithm>
#include <limits>

#include "grid/face_flux.hpp"

namespace suffuse {

template <int Dim>
FluxCorrection<Dim>::FluxCorrection(const Grid<Dim>& grid, std::vector<char> held,
                                    std::vector<LeakyFace> walls)
    : grid_(grid), held_(std::move(held)), walls_(std::move(walls)) {
  const OwnRows& elements = grid.element_rows();
  for (int f = 0; f < grid.face_count(); ++f) {
    if (grid.is_border(f) && held_[f] == 0) continue;
    const int partner = grid.face_partner[f];
    if (partner == Grid<Dim>::on_other_rank || (partner >= 0 && partner < f)) continue;
    const bool left = elements.owns(grid.face_left[f]);
    const bool right = grid.is_border(f) ? left : elements.owns(grid.beyond(f));
    if (left && right) inner_.push_back(f);
    if (left != right) crossing_.push_back(f);
  }
  find_pieces();
}

template <int Dim>
void FluxCorrection<Dim>::find_pieces() {
  const int elements = grid_.mesh.element_count();
  DisjointSets sets(elements + 1);
  for (const int f : inner_) sets.join(grid_.face_left[f], beyond(f));
  // Each set by its lowest element in the whole mesh.
  std::vector<long> lowest(elements);
  const int of_outside = sets.find(elements);
  std::vector<SharedEdge> edges{{.a = outside, .b = outside}};
  for (const int e : grid_.own_elements()) {
    const int set = sets.find(e);
    lowest[e] = set == of_outside ? outside : grid_.element_number(set);
    if (set == e) edges.push_back({.a = lowest[e], .b = lowest[e]});
  }
  grid_.element_rows().exchange(lowest);
  for (const int f : crossing_) {
    if (!grid_.owns_face(f)) continue;
    edges.push_back({.a = lowest[grid_.face_left[f]], .b = lowest[grid_.beyond(f)]});
  }
  const SharedSets pieces(grid_.ranks(), edges);
  // The outside has the lowest number of all.
  const std::vector<long> sealed(pieces.all_lowest().begin() + 1, pieces.all_lowest().end());
  sealed_root_.assign(sealed.size(), none);
  sealed_piece_.assign(elements, none);
  for (const int e : grid_.own_elements()) {
    const long first = pieces.lowest(lowest[e]);
    if (first == outside) continue;
    const auto piece = std::ranges::lower_bound(sealed, first) - sealed.begin();
    sealed_piece_[e] = static_cast<int>(piece);
    if (grid_.element_number(e) == first) sealed_root_[piece] = e;
  }
  grid_.element_rows().exchange(sealed_piece_);
}

template <int Dim>
void FluxCorrection<Dim>::follow(const std::vector<double>& conductance) {
  if (!followed_.empty()) {
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (const int e : grid_.own_elements()) {
      const double change = conductance[e] / followed_[e];
      least = std::min(least, change);
      most = std::max(most, change);
    }
    least = smallest_of_all(grid_.ranks(), least);
    if (largest_of_all(grid_.ranks(), most) <= stale_change * least) return;
  }
  followed_ = conductance;
  build_tree();
}

template <int Dim>
std::vector<double> FluxCorrection<Dim>::face_conductances() const {
  std::vector<double> result(grid_.face_count());
  for (const std::vector<int>* faces : {&inner_, &crossing_}) {
    for (const int f : *faces) {
      double value = followed_[grid_.face_left[f]];
      if (!grid_.is_border(f)) value = std::min(value, followed_[grid_.beyond(f)]);
      result[f] = value * grid_.face_normal[f].squaredNorm();
    }
  }
  for (const LeakyFace& wall : walls_) {
    result[wall.face] = std::min(result[wall.face], wall.conductance);
  }
  return result;
}

template <int Dim>
std::vector<char> FluxCorrection<Dim>::choose_faces() const {
  // Kruskal, Proc. Amer. Math. Soc. 7 (1956) 48, from the best conducting face down.
  const int elements = grid_.mesh.element_count();
  const std::vector<double> conductance = face_conductances();
  std::vector<int> by_conductance = inner_;
  std::stable_sort(by_conductance.begin(), by_conductance.end(),
                   [&](int a, int b) { return conductance[a] > conductance[b]; });
  DisjointSets joined(elements + 1);
  std::vector<char> in_tree(grid_.face_count(), 0);
  // Per set, an element that reaches another rank, or the outside; nothing if there is none.
  constexpr long nothing = -2;
  std::vector<long> reaches(elements + 1, nothing);
  reaches.back() = outside;
  for (const int f : crossing_) {
    for (const int e : {grid_.face_left[f], grid_.beyond(f)}) reaches[e] = grid_.element_number(e);
  }
  std::vector<SharedEdge> edges;
  std::vector<int> doubtful;
  for (const int f : by_conductance) {
    const long left = reaches[joined.find(grid_.face_left[f])];
    const long right = reaches[joined.find(beyond(f))];
    if (!joined.join(grid_.face_left[f], beyond(f))) continue;
    in_tree[f] = 1;
    reaches[joined.find(grid_.face_left[f])] = left == nothing ? right : left;
    if (crossing_.empty() || left == nothing || right == nothing) continue;
    edges.push_back({conductance[f], grid_.face_number(f), left, right});
    doubtful.push_back(f);
  }
  if (grid_.ranks().count() > 1) {
    for (const int f : crossing_) {
      if (!grid_.owns_face(f)) continue;
      edges.push_back({conductance[f], grid_.face_number(f),
                       grid_.element_number(grid_.face_left[f]),
                       grid_.element_number(grid_.beyond(f))});
    }
    const std::vector<long> chosen = heaviest_forest(grid_.ranks(), edges);
    for (const std::vector<int>* faces :
         {static_cast<const std::vector<int>*>(&doubtful), &crossing_}) {
      for (const int f : *faces) {
        in_tree[f] = std::ranges::binary_search(chosen, grid_.face_number(f)) ? 1 : 0;
      }
    }
  }
  for (const int f : inner_) {
    if (in_tree[f] != 0 && grid_.face_partner[f] >= 0) in_tree[grid_.face_partner[f]] = 1;
  }
  return in_tree;
}

template <int Dim>
void FluxCorrection<Dim>::build_tree() {
  const std::vector<char> in_tree = choose_faces();
  drain_.assign(grid_.mesh.elements.size(), none);
  from_root_.clear();
  from_root_.reserve(grid_.mesh.elements.size());
  for (const int f : inner_) {
    if (in_tree[f] != 0 && grid_.is_border(f)) {
      drain_[grid_.face_left[f]] = f;
      from_root_.push_back(grid_.face_left[f]);
    }
  }
  for (const int e : sealed_root_) {
    if (e >= 0) from_root_.push_back(e);
  }
  if (grid_.ranks().count() > 1) join_parts(in_tree);
  const OwnRows& own = grid_.element_rows();
  for (std::size_t i = 0; i < from_root_.size(); ++i) {
    const int e = from_root_[i];
    for (const int f : grid_.element_face[e]) {
      if (in_tree[f] == 0 || f == drain_[e] || grid_.is_border(f)) continue;
      const int next = grid_.beyond(f, e);
      if (!own.owns(next)) continue;
      const int partner = grid_.face_partner[f];
      drain_[next] = partner < 0 ? f : partner;
      from_root_.push_back(next);
    }
  }
}

template <int Dim>
void FluxCorrection<Dim>::join_parts(const std::vector<char>& in_tree) {
  DisjointSets sets(grid_.mesh.element_count());
  for (const int f : inner_) {
    if (in_tree[f] != 0 && !grid_.is_border(f)) sets.join(grid_.face_left[f], grid_.beyond(f));
  }
  part_.assign(grid_.mesh.elements.size(), none);
  for (const int e : grid_.own_elements()) part_[e] = grid_.element_number(sets.find(e));
  grid_.element_rows().exchange(part_);
  std::vector<long> roots;
  for (const int e : from_root_) roots.push_back(part_[e]);
  std::vector<SharedEdge> edges;
  for (const int f : crossing_) {
    if (in_tree[f] == 0 || !grid_.owns_face(f)) continue;
    edges.push_back({.number = grid_.face_number(f),
                     .a = part_[grid_.face_left[f]],
                     .b = part_[grid_.beyond(f)]});
  }
  parts_ = SharedForest(grid_.ranks(), edges, roots);
  passages_.clear();
  for (const int f : crossing_) {
    if (in_tree[f] == 0) continue;
    const bool left = grid_.element_rows().owns(grid_.face_left[f]);
    const int own = left ? grid_.face_left[f] : grid_.beyond(f);
    const int other = left ? grid_.beyond(f) : grid_.face_left[f];
    const bool is_inflow = parts_.drain(part_[other]) == grid_.face_number(f);
    passages_.push_back({f, own, is_inflow ? part_[other] : part_[own], is_inflow});
    if (is_inflow) continue;
    drain_[own] = f;
    from_root_.push_back(own);
  }
}

template <int Dim>
void FluxCorrection<Dim>::correct_between_ranks(std::vector<double>& face_flux,
                                                std::vector<double>& excess) const {
  std::vector<SharedForest::Value> own;
  for (const int e : grid_.own_elements()) {
    // Parts come one after the other or mixed; each value is added where its part is.
    if (own.empty() || own.back().node != part_[e]) own.push_back({part_[e], 0.0});
    own.back().value += excess[e];
  }
  const std::vector<SharedForest::Value> drained = parts_.drained(grid_.ranks(), own);
  for (const Passage& passage : passages_) {
    const double value =
        std::ranges::lower_bound(drained, passage.part, {}, &SharedForest::Value::node)->value;
    const bool is_left = grid_.face_left[passage.face] == passage.element;
    // The part drains out of its own element.
    face_flux[passage.face] -= is_left != passage.is_inflow ? value : -value;
    if (passage.is_inflow) excess[passage.element] += value;
  }
}

template <int Dim>
void FluxCorrection<Dim>::correct(std::vector<double>& face_flux,
                                  const std::vector<double>& net_outflow) const {
  std::vector<double> excess(grid_.mesh.elements.size());
  for (const int e : grid_.own_elements()) {
    excess[e] = outflow(grid_, e, face_flux) - net_outflow[e];
  }
  if (grid_.ranks().count() > 1) correct_between_ranks(face_flux, excess);
  const OwnRows& own = grid_.element_rows();
  for (std::size_t i = from_root_.size(); i-- > 0;) {
    const int e = from_root_[i];
    const int f = drain_[e];
    if (f < 0) continue;
    const bool is_left = grid_.face_left[f] == e;
    const int receiver = grid_.beyond(f, e);
    if (receiver >= 0 && !own.owns(receiver)) continue;  // done between ranks
    face_flux[f] -= is_left ? excess[e] : -excess[e];
    if (grid_.face_partner[f] >= 0) face_flux[grid_.face_partner[f]] = -face_flux[f];
    if (receiver >= 0) excess[receiver] += excess[e];
  }
  grid_.face_rows().exchange(face_flux);
}

template class FluxCorrection<2>;
template class FluxCorrection<3>;

}  // namespace suffuse
