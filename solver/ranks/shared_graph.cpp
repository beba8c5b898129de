#include "ranks/shared_graph.hpp"

#include <algorithm>

#include "ranks/disjoint_sets.hpp"

namespace suffuse {
namespace {

std::vector<long> ends_of(const std::vector<SharedEdge>& edges) {
  std::vector<long> nodes;
  for (const SharedEdge& edge : edges) nodes.insert(nodes.end(), {edge.a, edge.b});
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

int place_of(const std::vector<long>& nodes, long node) {
  return static_cast<int>(std::ranges::lower_bound(nodes, node) - nodes.begin());
}

}  // namespace

SharedSets::SharedSets(const Ranks& ranks, const std::vector<SharedEdge>& own) {
  const std::vector<SharedEdge> edges = values_on_all(ranks, own);
  nodes_ = ends_of(edges);
  DisjointSets sets(static_cast<int>(nodes_.size()));
  for (const SharedEdge& edge : edges)
    sets.join(place_of(nodes_, edge.a), place_of(nodes_, edge.b));
  // A set is named by its lowest place.
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    lowest_.push_back(nodes_[sets.find(i)]);
    if (sets.find(i) == i) all_lowest_.push_back(nodes_[i]);
  }
}

long SharedSets::lowest(long node) const {
  return lowest_[place_of(nodes_, node)];
}

std::vector<long> heaviest_forest(const Ranks& ranks, const std::vector<SharedEdge>& own) {
  std::vector<SharedEdge> edges = values_on_all(ranks, own);
  std::ranges::sort(edges, [](const SharedEdge& a, const SharedEdge& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.number < b.number;
  });
  const std::vector<long> nodes = ends_of(edges);
  DisjointSets joined(static_cast<int>(nodes.size()));
  std::vector<long> numbers;
  for (const SharedEdge& edge : edges) {
    if (joined.join(place_of(nodes, edge.a), place_of(nodes, edge.b))) {
      numbers.push_back(edge.number);
    }
  }
  std::ranges::sort(numbers);
  return numbers;
}

SharedForest::SharedForest(const Ranks& ranks, const std::vector<SharedEdge>& edges,
                           const std::vector<long>& roots) {
  std::vector<SharedEdge> all = values_on_all(ranks, edges);
  std::vector<long> all_roots = values_on_all(ranks, roots);
  std::ranges::sort(all_roots);
  std::ranges::sort(all, {}, &SharedEdge::number);
  std::vector<SharedEdge> with_roots = all;
  for (const long root : all_roots) with_roots.push_back({.a = root, .b = root});
  nodes_ = ends_of(with_roots);
  struct Way {
    long number;
    int to;
  };
  std::vector<std::vector<Way>> ways(nodes_.size());
  for (const SharedEdge& edge : all) {
    const int a = place_of(nodes_, edge.a);
    const int b = place_of(nodes_, edge.b);
    ways[a].push_back({edge.number, b});
    ways[b].push_back({edge.number, a});
  }
  constexpr int not_reached = -2;
  receiver_.assign(nodes_.size(), not_reached);
  drain_.assign(nodes_.size(), -1);
  std::vector<int> from_root;
  for (const long root : all_roots) {
    receiver_[place_of(nodes_, root)] = -1;
    from_root.push_back(place_of(nodes_, root));
  }
  for (std::size_t i = 0; i < from_root.size(); ++i) {
    for (const Way& way : ways[from_root[i]]) {
      if (receiver_[way.to] != not_reached) continue;
      receiver_[way.to] = from_root[i];
      drain_[way.to] = way.number;
      from_root.push_back(way.to);
    }
  }
  to_root_.assign(from_root.rbegin(), from_root.rend());
}

std::size_t SharedForest::place(long node) const {
  return static_cast<std::size_t>(place_of(nodes_, node));
}

long SharedForest::drain(long node) const {
  return drain_[place(node)];
}

std::vector<SharedForest::Value> SharedForest::drained(const Ranks& ranks,
                                                       const std::vector<Value>& own) const {
  std::vector<Value> result;
  result.reserve(nodes_.size());
  for (const long node : nodes_) result.push_back({node, 0.0});
  for (const Value& value : values_on_all(ranks, own)) {
    result[place(value.node)].value += value.value;
  }
  for (const int i : to_root_) {
    if (receiver_[i] >= 0) result[receiver_[i]].value += result[i].value;
  }
  return result;
}

}  // namespace suffuse
