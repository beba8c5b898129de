#pragma once

/// Graphs of which each rank has a part. What is here is small: edges between parts, and what
/// stands for the parts themselves; all ranks get it all and find the same.

#include <vector>

#include "ranks/ranks.hpp"

namespace suffuse {

/// An edge between nodes whose numbers all ranks share.
struct SharedEdge {
  double weight = 0.0;
  long number = 0;  ///< of the edge; no other edge has it
  long a = 0;
  long b = 0;
};

/// Sets of nodes that edges connect.
class SharedSets {
 public:
  /// Finds the sets from the edges of all ranks, each given by one of them. A node without edges is
  /// given by an edge to itself.
  SharedSets(const Ranks& ranks, const std::vector<SharedEdge>& own);

  /// The lowest node of the set of a node, which some edge has.
  [[nodiscard]] long lowest(long node) const;
  /// The lowest node of each set, ascending.
  [[nodiscard]] const std::vector<long>& all_lowest() const { return all_lowest_; }

 private:
  std::vector<long> nodes_;   ///< ascending
  std::vector<long> lowest_;  ///< of each of them
  std::vector<long> all_lowest_;
};

/// Numbers of the edges of the spanning forest of largest weights, ascending (Kruskal, Proc. Amer.
/// Math. Soc. 7 (1956) 48). Of equal weights the lower number comes first. Each edge is given by
/// one rank.
std::vector<long> heaviest_forest(const Ranks& ranks, const std::vector<SharedEdge>& own);

/// A forest, and sums from its leaves to its roots.
class SharedForest {
 public:
  SharedForest() = default;
  /// `edges` and `roots` of all ranks, each given by one of them. Each node has a way to a root.
  SharedForest(const Ranks& ranks, const std::vector<SharedEdge>& edges,
               const std::vector<long>& roots);

  /// Number of the edge of a node towards its root; -1 at a root.
  [[nodiscard]] long drain(long node) const;
  /// For each node of the forest, ascending: the sum of the values of all nodes that drain through
  /// it, its own included. `own`: values of nodes, each given by one rank.
  struct Value {
    long node;
    double value;
  };
  [[nodiscard]] std::vector<Value> drained(const Ranks& ranks, const std::vector<Value>& own) const;

 private:
  [[nodiscard]] std::size_t place(long node) const;

  std::vector<long> nodes_;    ///< ascending
  std::vector<long> drain_;    ///< of each of them
  std::vector<int> receiver_;  ///< place of the node it drains to; -1 at a root
  std::vector<int> to_root_;   ///< places, each before the one it drains to
};

}  // namespace suffuse
