#include "ranks/mpi_ranks.hpp"

#include <petscsf.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace suffuse {
namespace {

void check(int error, const char* call) {
  if (error != 0) throw std::runtime_error(std::string(call) + " failed: " + std::to_string(error));
}

/// Digits of an exact sum, as they are sent.
constexpr int sum_size = sizeof(ExactSum);

/// Adds sums in a reduction of MPI.
void add_sums(void* in, void* in_out, int* count, MPI_Datatype* /*type*/) {
  const auto* from = static_cast<const ExactSum*>(in);
  auto* to = static_cast<ExactSum*>(in_out);
  for (int i = 0; i < *count; ++i) to[i].add(from[i]);
}

/// Bytes of one value, as a type of MPI.
class ValueType {
 public:
  explicit ValueType(std::size_t bytes) {
    check(MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_), "MPI_Type_contiguous");
    check(MPI_Type_commit(&type_), "MPI_Type_commit");
  }
  ~ValueType() { MPI_Type_free(&type_); }
  ValueType(const ValueType&) = delete;
  ValueType& operator=(const ValueType&) = delete;

  [[nodiscard]] MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

class StarForestHalo final : public Halo {
 public:
  /// `leaves`: local rows that are copies; `owners`: where they come from, by the place among the
  /// own rows there, which start at `first` here.
  StarForestHalo(int own, int first, std::vector<PetscInt> leaves, std::vector<PetscSFNode> owners)
      : first_(first) {
    check(PetscSFCreate(PETSC_COMM_WORLD, &forest_), "PetscSFCreate");
    check(PetscSFSetGraph(forest_, own, static_cast<PetscInt>(leaves.size()), leaves.data(),
                          PETSC_COPY_VALUES, owners.data(), PETSC_COPY_VALUES),
          "PetscSFSetGraph");
    check(PetscSFSetUp(forest_), "PetscSFSetUp");
  }
  ~StarForestHalo() override { PetscSFDestroy(&forest_); }
  StarForestHalo(const StarForestHalo&) = delete;
  StarForestHalo& operator=(const StarForestHalo&) = delete;

  void exchange(void* values, std::size_t bytes) const override {
    const ValueType type(bytes);
    const auto* own = static_cast<const char*>(values) + static_cast<std::size_t>(first_) * bytes;
    check(PetscSFBcastBegin(forest_, type.get(), own, values, MPI_REPLACE), "PetscSFBcastBegin");
    check(PetscSFBcastEnd(forest_, type.get(), own, values, MPI_REPLACE), "PetscSFBcastEnd");
  }

 private:
  int first_;
  PetscSF forest_ = nullptr;
};

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    check(MPI_Comm_rank(PETSC_COMM_WORLD, &rank_), "MPI_Comm_rank");
    check(MPI_Comm_size(PETSC_COMM_WORLD, &count_), "MPI_Comm_size");
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int count() const override { return count_; }

  void sum(const std::vector<ExactSum*>& sums) const override {
    std::vector<ExactSum> all;
    all.reserve(sums.size());
    for (const ExactSum* sum : sums) all.push_back(*sum);
    const ValueType type(sum_size);
    MPI_Op add = MPI_OP_NULL;
    check(MPI_Op_create(add_sums, 1, &add), "MPI_Op_create");
    check(MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), type.get(), add,
                        PETSC_COMM_WORLD),
          "MPI_Allreduce");
    check(MPI_Op_free(&add), "MPI_Op_free");
    for (std::size_t i = 0; i < sums.size(); ++i) *sums[i] = all[i];
  }

  void largest(std::span<double> values) const override {
    check(MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE,
                        MPI_MAX, PETSC_COMM_WORLD),
          "MPI_Allreduce");
  }

  [[nodiscard]] long before(long count) const override {
    long sum = 0;
    check(MPI_Exscan(&count, &sum, 1, MPI_LONG, MPI_SUM, PETSC_COMM_WORLD), "MPI_Exscan");
    return rank_ == 0 ? 0 : sum;
  }

  [[nodiscard]] OwnRows rows(const std::vector<long>& global, int first, int last) const override {
    // The first own row of each rank in the whole mesh. Ranks without own rows begin where the next
    // one does.
    const long start = before(last - first);
    std::vector<long> starts(static_cast<std::size_t>(count_));
    check(MPI_Allgather(&start, 1, MPI_LONG, starts.data(), 1, MPI_LONG, PETSC_COMM_WORLD),
          "MPI_Allgather");
    std::vector<PetscInt> leaves;
    std::vector<PetscSFNode> owners;
    for (std::size_t i = 0; i < global.size(); ++i) {
      const int row = static_cast<int>(i);
      if (row >= first && row < last) continue;
      const auto owner = std::ranges::upper_bound(starts, global[i]) - starts.begin() - 1;
      leaves.push_back(row);
      owners.push_back(
          {static_cast<PetscInt>(owner),
           static_cast<PetscInt>(global[i] - starts[static_cast<std::size_t>(owner)])});
    }
    return {first, last,
            std::make_shared<StarForestHalo>(last - first, first, std::move(leaves),
                                             std::move(owners))};
  }

 private:
  int rank_ = 0;
  int count_ = 1;
};

}  // namespace

MpiProcess::MpiProcess() {
  check(PetscInitializeNoArguments(), "PetscInitialize");
  // Signals are the program's own.
  check(PetscPopSignalHandler(), "PetscPopSignalHandler");
}

MpiProcess::~MpiProcess() {
  PetscFinalize();
}

std::shared_ptr<const Ranks> mpi_ranks() {
  return std::make_shared<MpiRanks>();
}

}  // namespace suffuse
