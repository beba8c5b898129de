#include "ranks/petsc_factor.hpp"

#include <petscksp.h>

#include <algorithm>
#include <string>

#include "common/errors.hpp"
#include "ranks/petsc_check.hpp"

namespace suffuse {
namespace {

/// The caller refines the solution: it need not be more accurate than this.
constexpr double accuracy = 1e-6;
constexpr int most_iterations = 300;
constexpr const char* prefix = "suffuse_flow_";

/// For the matrices of mixed elements: docs/decisions.md.
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

class PetscFactor final : public SharedFactor {
 public:
  PetscFactor() {
    set_options();
    petsc_check(KSPCreate(PETSC_COMM_WORLD, &solver_), "KSPCreate");
    petsc_check(KSPSetOptionsPrefix(solver_, prefix), "KSPSetOptionsPrefix");
    petsc_check(KSPSetType(solver_, KSPCG), "KSPSetType");
    petsc_check(KSPSetNormType(solver_, KSP_NORM_NATURAL), "KSPSetNormType");
    petsc_check(KSPSetTolerances(solver_, accuracy, PETSC_SMALL * PETSC_SMALL, PETSC_DEFAULT,
                                 most_iterations),
                "KSPSetTolerances");
    PC preconditioner = nullptr;
    petsc_check(KSPGetPC(solver_, &preconditioner), "KSPGetPC");
    petsc_check(PCSetType(preconditioner, PCHYPRE), "PCSetType");
    petsc_check(PCHYPRESetType(preconditioner, "boomeramg"), "PCHYPRESetType");
    petsc_check(KSPSetFromOptions(solver_), "KSPSetFromOptions");
  }
  ~PetscFactor() override {
    KSPDestroy(&solver_);
    MatDestroy(&matrix_);
    VecDestroy(&rhs_);
    VecDestroy(&solution_);
  }
  PetscFactor(const PetscFactor&) = delete;
  PetscFactor& operator=(const PetscFactor&) = delete;

  void factorise(const OwnMatrixRows& rows) override {
    const auto own = static_cast<PetscInt>(rows.count());
    const auto whole = static_cast<PetscInt>(rows.whole);
    const std::vector<PetscInt> begin(rows.begin.begin(), rows.begin.end());
    const std::vector<PetscInt> column(rows.column.begin(), rows.column.end());
    MatDestroy(&matrix_);
    petsc_check(MatCreate(PETSC_COMM_WORLD, &matrix_), "MatCreate");
    petsc_check(MatSetSizes(matrix_, own, own, whole, whole), "MatSetSizes");
    petsc_check(MatSetType(matrix_, MATMPIAIJ), "MatSetType");
    petsc_check(
        MatMPIAIJSetPreallocationCSR(matrix_, begin.data(), column.data(), rows.value.data()),
        "MatMPIAIJSetPreallocationCSR");
    petsc_check(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE), "MatSetOption");
    petsc_check(KSPSetOperators(solver_, matrix_, matrix_), "KSPSetOperators");
    petsc_check(KSPSetUp(solver_), "KSPSetUp");
    if (rhs_ != nullptr) return;
    petsc_check(VecCreateMPI(PETSC_COMM_WORLD, own, whole, &rhs_), "VecCreateMPI");
    petsc_check(VecDuplicate(rhs_, &solution_), "VecDuplicate");
  }

  int solve(const std::vector<double>& rhs, std::vector<double>& x) override {
    double* values = nullptr;
    petsc_check(VecGetArray(rhs_, &values), "VecGetArray");
    std::ranges::copy(rhs, values);
    petsc_check(VecRestoreArray(rhs_, &values), "VecRestoreArray");
    petsc_check(KSPSolve(solver_, rhs_, solution_), "KSPSolve");
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    petsc_check(KSPGetConvergedReason(solver_, &reason), "KSPGetConvergedReason");
    PetscInt iterations = 0;
    petsc_check(KSPGetIterationNumber(solver_, &iterations), "KSPGetIterationNumber");
    if (reason < 0) {
      throw NumericalError("the pressures could not be solved for: " + std::to_string(iterations) +
                           " iterations with BoomerAMG are not enough");
    }
    x.resize(rhs.size());
    const double* found = nullptr;
    petsc_check(VecGetArrayRead(solution_, &found), "VecGetArrayRead");
    std::copy_n(found, x.size(), x.begin());
    petsc_check(VecRestoreArrayRead(solution_, &found), "VecRestoreArrayRead");
    return static_cast<int>(iterations);
  }

 private:
  KSP solver_ = nullptr;
  Mat matrix_ = nullptr;
  Vec rhs_ = nullptr;
  Vec solution_ = nullptr;
};

}  // namespace

std::unique_ptr<SharedFactor> petsc_factor() {
  return std::make_unique<PetscFactor>();
}

}  // namespace suffuse
