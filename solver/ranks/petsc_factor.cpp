#include "ranks/petsc_factor.hpp"

#include <petscksp.h>

#include <algorithm>
#include <string>

#include "common/errors.hpp"
#include "ranks/petsc_check.hpp"

namespace suffuse {
namespace {

/// The caller refines the solution: it need not be more accurate than this.
constexpr double symmetric_accuracy = 1e-6;
constexpr double tangent_accuracy = 1e-9;
constexpr int most_iterations = 300;
constexpr int most_directions = 60;
constexpr const char* prefix = "suffuse_flow_";

/// For the matrices of mixed elements: docs/develop/decisions.md.
void set_options() {
  constexpr const char* options[][2] = {{"pc_hypre_boomeramg_strong_threshold", "0.25"},
                                        {"pc_hypre_boomeramg_coarsen_type", "HMIS"},
                                        {"pc_hypre_boomeramg_interp_type", "ext+i"},
                                        {"pc_hypre_boomeramg_P_max", "4"}};
  for (const auto& [name, value] : options) {
    petsc_check(PetscOptionsSetValue(nullptr, ("-" + std::string(prefix) + name).c_str(), value),
                "PetscOptionsSetValue");
  }
}

/// Creates the rows of a matrix that this rank owns.
Mat matrix_of(const OwnMatrixRows& rows) {
  const auto own = static_cast<PetscInt>(rows.count());
  const auto whole = static_cast<PetscInt>(rows.whole);
  const std::vector<PetscInt> begin(rows.begin.begin(), rows.begin.end());
  const std::vector<PetscInt> column(rows.column.begin(), rows.column.end());
  Mat matrix = nullptr;
  petsc_check(MatCreate(PETSC_COMM_WORLD, &matrix), "MatCreate");
  petsc_check(MatSetSizes(matrix, own, own, whole, whole), "MatSetSizes");
  petsc_check(MatSetType(matrix, MATMPIAIJ), "MatSetType");
  petsc_check(MatMPIAIJSetPreallocationCSR(matrix, begin.data(), column.data(), rows.value.data()),
              "MatMPIAIJSetPreallocationCSR");
  return matrix;
}

/// An iteration of PETSc.
class Iteration {
 public:
  /// \param accuracy  of the residual, in the norm of the method
  Iteration(KSPType method, PC preconditioner, double accuracy) {
    petsc_check(KSPCreate(PETSC_COMM_WORLD, &solver_), "KSPCreate");
    petsc_check(KSPSetType(solver_, method), "KSPSetType");
    petsc_check(KSPSetPC(solver_, preconditioner), "KSPSetPC");
    petsc_check(KSPSetTolerances(solver_, accuracy, PETSC_SMALL * PETSC_SMALL, PETSC_DEFAULT,
                                 most_iterations),
                "KSPSetTolerances");
  }
  ~Iteration() { KSPDestroy(&solver_); }
  Iteration(const Iteration&) = delete;
  Iteration& operator=(const Iteration&) = delete;

  [[nodiscard]] KSP solver() const { return solver_; }
  /// Solves matrix x = rhs. Returns whether x was found.
  bool solve(Mat matrix, Mat preconditions, Vec rhs, Vec x) {
    petsc_check(KSPSetOperators(solver_, matrix, preconditions), "KSPSetOperators");
    petsc_check(KSPSolve(solver_, rhs, x), "KSPSolve");
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    petsc_check(KSPGetConvergedReason(solver_, &reason), "KSPGetConvergedReason");
    PetscInt iterations = 0;
    petsc_check(KSPGetIterationNumber(solver_, &iterations), "KSPGetIterationNumber");
    iterations_ = static_cast<int>(iterations);
    return reason > 0;
  }
  /// Iterations of the last solution.
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  KSP solver_ = nullptr;
  int iterations_ = 0;
};

class PetscFactor final : public SharedFactor {
 public:
  PetscFactor()
      : preconditioner_(new_preconditioner()),
        symmetric_(KSPCG, preconditioner_, symmetric_accuracy),
        tangent_(KSPBCGS, preconditioner_, tangent_accuracy),
        patient_(KSPGMRES, preconditioner_, tangent_accuracy) {
    petsc_check(KSPSetNormType(symmetric_.solver(), KSP_NORM_NATURAL), "KSPSetNormType");
    // Then the norm is that of the residual itself.
    petsc_check(KSPSetPCSide(tangent_.solver(), PC_RIGHT), "KSPSetPCSide");
    petsc_check(KSPSetPCSide(patient_.solver(), PC_RIGHT), "KSPSetPCSide");
    petsc_check(KSPGMRESSetRestart(patient_.solver(), most_directions), "KSPGMRESSetRestart");
  }
  ~PetscFactor() override {
    PCDestroy(&preconditioner_);
    MatDestroy(&matrix_);
    VecDestroy(&rhs_);
    VecDestroy(&solution_);
  }
  PetscFactor(const PetscFactor&) = delete;
  PetscFactor& operator=(const PetscFactor&) = delete;

  void factorise(const OwnMatrixRows& rows) override {
    MatDestroy(&matrix_);
    matrix_ = matrix_of(rows);
    petsc_check(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE), "MatSetOption");
    if (rhs_ != nullptr) return;
    petsc_check(VecCreateMPI(PETSC_COMM_WORLD, rows.count(), PETSC_DETERMINE, &rhs_),
                "VecCreateMPI");
    petsc_check(VecDuplicate(rhs_, &solution_), "VecDuplicate");
  }

  int solve(const std::vector<double>& rhs, std::vector<double>& x) override {
    set(rhs);
    const bool found = symmetric_.solve(matrix_, matrix_, rhs_, solution_);
    if (!found) refuse(symmetric_.iterations());
    get(x);
    return symmetric_.iterations();
  }

  int solve_near(const OwnMatrixRows& tangent, const std::vector<double>& rhs,
                 std::vector<double>& x) override {
    set(rhs);
    Mat matrix = matrix_of(tangent);
    int iterations = 0;
    bool found = false;
    for (Iteration* iteration : {&tangent_, &patient_}) {
      if (found) break;
      found = iteration->solve(matrix, matrix_, rhs_, solution_);
      iterations += iteration->iterations();
    }
    MatDestroy(&matrix);
    if (!found) refuse(iterations);
    get(x);
    return iterations;
  }

 private:
  static PC new_preconditioner() {
    set_options();
    PC result = nullptr;
    petsc_check(PCCreate(PETSC_COMM_WORLD, &result), "PCCreate");
    petsc_check(PCSetOptionsPrefix(result, prefix), "PCSetOptionsPrefix");
    petsc_check(PCSetType(result, PCHYPRE), "PCSetType");
    petsc_check(PCHYPRESetType(result, "boomeramg"), "PCHYPRESetType");
    petsc_check(PCSetFromOptions(result), "PCSetFromOptions");
    return result;
  }
  [[noreturn]] static void refuse(int iterations) {
    throw NumericalError("a linear system could not be solved: " + std::to_string(iterations) +
                         " iterations with BoomerAMG are not enough");
  }
  void set(const std::vector<double>& rhs) {
    double* values = nullptr;
    petsc_check(VecGetArray(rhs_, &values), "VecGetArray");
    std::ranges::copy(rhs, values);
    petsc_check(VecRestoreArray(rhs_, &values), "VecRestoreArray");
  }
  void get(std::vector<double>& x) {
    PetscInt count = 0;
    petsc_check(VecGetLocalSize(solution_, &count), "VecGetLocalSize");
    x.resize(static_cast<std::size_t>(count));
    const double* found = nullptr;
    petsc_check(VecGetArrayRead(solution_, &found), "VecGetArrayRead");
    std::copy_n(found, x.size(), x.begin());
    petsc_check(VecRestoreArrayRead(solution_, &found), "VecRestoreArrayRead");
  }

  PC preconditioner_ = nullptr;
  Iteration symmetric_;
  Iteration tangent_;
  Iteration patient_;  ///< where `tangent_` does not converge
  Mat matrix_ = nullptr;
  Vec rhs_ = nullptr;
  Vec solution_ = nullptr;
};

}  // namespace

std::unique_ptr<SharedFactor> petsc_factor() {
  return std::make_unique<PetscFactor>();
}

}  // namespace suffuse
