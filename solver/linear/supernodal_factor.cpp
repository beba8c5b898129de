#include "linear/supernodal_factor.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "grid/parallel.hpp"

namespace suffuse {
namespace {

/// Smaller factors are solved before other threads are awake.
constexpr std::size_t worth_branches = 200'000;
/// Branches hold so much of the factor at most: several for each thread, to even out.
constexpr std::size_t branch_share = 16;

/// Products are added up in parts of so many rows, which stay in the nearest cache.
constexpr int part_rows = 256;

}  // namespace

void ReleasableLdlt::factorize(const Eigen::SparseMatrix<double>& matrix) {
  // The places where columns begin stay; they say how many entries there are.
  m_matrix.resizeNonZeros(m_matrix.outerIndexPtr()[m_matrix.cols()]);
  SimplicialLDLT::factorize(matrix);
}

void ReleasableLdlt::release() {
  m_matrix.data().clear();
  m_matrix.data().squeeze();
}

void SupernodalFactor::find_supernodes(const Matrix& lower) {
  const int* begins = lower.outerIndexPtr();
  const int* rows = lower.innerIndexPtr();
  const auto columns = static_cast<int>(lower.cols());
  const auto count = [&](int column) { return begins[column + 1] - begins[column]; };
  std::vector<int> node_of(columns);
  columns_ = columns;
  nodes_.clear();
  rows_.clear();
  std::size_t panel = 0;
  for (int column = 0; column < columns;) {
    Supernode node;
    node.begin = column;
    while (column + 1 < columns && count(column) == count(column + 1) + 1 &&
           rows[begins[column]] == column + 1) {
      ++column;
    }
    node.end = ++column;
    node.rows_begin = static_cast<int>(rows_.size());
    rows_.insert(rows_.end(), rows + begins[column - 1], rows + begins[column]);
    node.rows_end = static_cast<int>(rows_.size());
    node.panel = panel;
    panel += node.size();
    std::fill(node_of.begin() + node.begin, node_of.begin() + node.end,
              static_cast<int>(nodes_.size()));
    nodes_.push_back(node);
  }
  for (Supernode& node : nodes_) {
    if (node.below() > 0) node.parent = node_of[rows_[node.rows_begin]];
  }
  panels_.resize(panel);
}

void SupernodalFactor::find_branches() {
  const auto count = static_cast<int>(nodes_.size());
  std::vector<std::size_t> weight(count);  // of a node and all below it
  std::vector<int> first(count);
  std::vector<int> members(count, 1);
  std::iota(first.begin(), first.end(), 0);
  for (int n = 0; n < count; ++n) {
    weight[n] += nodes_[n].size();
    const int parent = nodes_[n].parent;
    if (parent < 0) continue;
    weight[parent] += weight[n];
    members[parent] += members[n];
    first[parent] = std::min(first[parent], first[n]);
  }
  branches_.clear();
  top_.clear();
  const std::size_t most = panels_.size() < worth_branches ? 0 : panels_.size() / branch_share;
  // From the root down: whole where it is small enough and its nodes stand in a row.
  int next = count;
  for (int n = count - 1; n >= 0; --n) {
    if (n >= next) continue;
    if (weight[n] <= most && n - first[n] + 1 == members[n]) {
      branches_.push_back({first[n], n + 1});
      next = first[n];
    } else {
      top_.push_back(n);
    }
  }
  std::reverse(branches_.begin(), branches_.end());
  std::reverse(top_.begin(), top_.end());
}

void SupernodalFactor::send_rows_of_branches() {
  top_columns_.clear();
  std::vector<int> place(columns_, -1);
  for (const int n : top_) {
    for (int column = nodes_[n].begin; column < nodes_[n].end; ++column) {
      place[column] = static_cast<int>(top_columns_.size());
      top_columns_.push_back(column);
    }
  }
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    for (int n = branches_[b].begin; n < branches_[b].end; ++n) {
      for (int k = nodes_[n].rows_begin; k < nodes_[n].rows_end; ++k) {
        if (place[rows_[k]] >= 0) rows_[k] = static_cast<int>(place_of(b)) + place[rows_[k]];
      }
    }
  }
  vector_.resize(place_of(branches_.size()));
}

void SupernodalFactor::take(const Ldlt& factor) {
  const Matrix& lower = factor.matrixL().nestedExpression();
  if (nodes_.empty()) {
    find_supernodes(lower);
    find_branches();
    send_rows_of_branches();
  }
  diagonal_ = factor.vectorD();
  order_ = factor.permutationP().indices();
  for_each_index(static_cast<int>(nodes_.size()), threads_, [&](int n) {
    const Supernode& node = nodes_[n];
    const int length = node.width() + node.below();
    for (int j = 0; j < node.width(); ++j) {
      const int begin = lower.outerIndexPtr()[node.begin + j];
      double* column = &panels_[node.panel + static_cast<std::size_t>(j) * length];
      std::fill(column, column + j + 1, 0.0);
      std::copy(lower.valuePtr() + begin, lower.valuePtr() + begin + (length - j - 1),
                column + j + 1);
    }
  });
}

void SupernodalFactor::forward(const Supernode& node) {
  const int width = node.width();
  const int below = node.below();
  const int length = width + below;
  const double* panel = &panels_[node.panel];
  double* x = &vector_[node.begin];
  for (int j = 0; j + 1 < width; ++j) {
    const double* column = panel + static_cast<std::size_t>(j) * length;
    for (int i = j + 1; i < width; ++i) x[i] -= column[i] * x[j];
  }
  const int* rows = rows_.data() + node.rows_begin;
  std::array<double, part_rows> sum;
  for (int part = 0; part < below; part += part_rows) {
    const int size = std::min(part_rows, below - part);
    const double* column = panel + width + part;
    for (int i = 0; i < size; ++i) sum[i] = column[i] * x[0];
    for (int j = 1; j < width; ++j) {
      column += length;
      for (int i = 0; i < size; ++i) sum[i] += column[i] * x[j];
    }
    for (int i = 0; i < size; ++i) vector_[rows[part + i]] -= sum[i];
  }
}

void SupernodalFactor::backward(const Supernode& node) {
  const int width = node.width();
  const int below = node.below();
  const int length = width + below;
  const double* panel = &panels_[node.panel];
  double* x = &vector_[node.begin];
  const int* rows = rows_.data() + node.rows_begin;
  std::array<double, part_rows> known;
  for (int part = 0; part < below; part += part_rows) {
    const int size = std::min(part_rows, below - part);
    for (int i = 0; i < size; ++i) known[i] = vector_[rows[part + i]];
    const double* column = panel + width + part;
    for (int j = 0; j < width; ++j, column += length) {
      double sum = 0.0;
#pragma omp simd reduction(+ : sum)
      for (int i = 0; i < size; ++i) sum += column[i] * known[i];
      x[j] -= sum;
    }
  }
  for (int j = width - 2; j >= 0; --j) {
    const double* column = panel + static_cast<std::size_t>(j) * length;
    double sum = 0.0;
    for (int i = j + 1; i < width; ++i) sum += column[i] * x[i];
    x[j] -= sum;
  }
}

template <class Visit>
void SupernodalFactor::for_each_branch(const Visit& visit) {
  const auto count = static_cast<int>(branches_.size());
  if (threads_ <= 1 || count < 2) {
    for (int b = 0; b < count; ++b) visit(b);
    return;
  }
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_)
  for (int b = 0; b < count; ++b) visit(b);
}

void SupernodalFactor::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  const auto columns = static_cast<int>(columns_);
  const std::size_t top = top_columns_.size();
  x.resize(columns);
  for_each_index(columns, threads_, [&](int i) { vector_[order_[i]] = rhs[i]; });
  for_each_branch([&](int b) {
    std::fill_n(&vector_[place_of(b)], top, 0.0);
    for (int n = branches_[b].begin; n < branches_[b].end; ++n) forward(nodes_[n]);
  });
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const double* added = &vector_[place_of(b)];
    for (std::size_t i = 0; i < top; ++i) vector_[top_columns_[i]] += added[i];
  }
  for (const int n : top_) forward(nodes_[n]);
  for_each_index(columns, threads_, [&](int i) { vector_[i] /= diagonal_[i]; });
  for (std::size_t i = top_.size(); i-- > 0;) backward(nodes_[top_[i]]);
  for_each_branch([&](int b) {
    double* known = &vector_[place_of(b)];
    for (std::size_t i = 0; i < top; ++i) known[i] = vector_[top_columns_[i]];
    for (int n = branches_[b].end; n-- > branches_[b].begin;) backward(nodes_[n]);
  });
  for_each_index(columns, threads_, [&](int i) { x[i] = vector_[order_[i]]; });
}

}  // namespace suffuse
