#pragma once

/// Solves with a sparse Cholesky factor again and again: the memory it takes to read the factor is
/// what a solution costs.

#include <Eigen/SparseCholesky>
#include <vector>

namespace suffuse {

/// Eigen's, which can give back the memory of its factor once that is copied.
class ReleasableLdlt : public Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> {
 public:
  using SimplicialLDLT::SimplicialLDLT;

  /// As Eigen's, after a release too.
  void factorize(const Eigen::SparseMatrix<double>& matrix);
  /// Nothing but `factorize` may be asked for after this.
  void release();
};

/// A factor L D L^T as dense panels: columns in a row with the same rows below them share one list
/// of these (supernodes; Ng and Peyton, SIAM J. Sci. Comput. 14 (1993) 1034). Branches of the
/// elimination tree are solved side by side; what each adds to the columns above is added up in a
/// fixed order, so that the solution is the same, bit by bit, on any number of threads.
class SupernodalFactor {
 public:
  using Ldlt = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

  explicit SupernodalFactor(int threads) : threads_(threads) {}

  /// Takes the values of a factor. The pattern must be the same in every call.
  void take(const Ldlt& factor);

  /// x = (L D L^T)^-1 rhs, in the order of the matrix that was factored.
  void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x);

 private:
  /// Columns [begin, end) and the rows below them. Its panel has a column for each, of end - begin
  /// rows of the columns themselves (the unit triangle) and then those below.
  struct Supernode {
    int begin = 0;
    int end = 0;
    int rows_begin = 0;  ///< of the list of rows below
    int rows_end = 0;
    std::size_t panel = 0;
    int parent = -1;  ///< supernode of the first row below

    [[nodiscard]] int width() const { return end - begin; }
    [[nodiscard]] int below() const { return rows_end - rows_begin; }
    [[nodiscard]] std::size_t size() const {
      return static_cast<std::size_t>(width()) * (width() + below());
    }
  };
  /// Supernodes [begin, end) that hang together and reach others only in the top.
  struct Branch {
    int begin;
    int end;
  };
  using Matrix = Eigen::SparseMatrix<double>;

  void find_supernodes(const Matrix& lower);
  void find_branches();
  /// Rows outside a branch are sent to places of its own behind the vector.
  void send_rows_of_branches();
  void forward(const Supernode& node);
  void backward(const Supernode& node);
  template <class Visit>
  void for_each_branch(const Visit& visit);
  [[nodiscard]] std::size_t place_of(std::size_t branch) const {
    return columns_ + branch * top_columns_.size();
  }

  int threads_;
  std::size_t columns_ = 0;
  std::vector<Supernode> nodes_;
  std::vector<int> rows_;
  std::vector<double> panels_;
  std::vector<Branch> branches_;
  std::vector<int> top_;          ///< supernodes in no branch, ascending
  std::vector<int> top_columns_;  ///< their columns
  Eigen::VectorXd diagonal_;
  Eigen::VectorXi order_;       ///< place of each row in the factor
  std::vector<double> vector_;  ///< in the factor's order, then a copy of the top per branch
};

}  // namespace suffuse
