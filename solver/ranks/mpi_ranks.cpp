#include "ranks/mpi_ranks.hpp"

#include <petscsf.h>
#include <sys/prctl.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

#include "ranks/petsc_check.hpp"
#include "ranks/petsc_factor.hpp"

namespace suffuse {
namespace {

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
    petsc_check(MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_),
                "MPI_Type_contiguous");
    petsc_check(MPI_Type_commit(&type_), "MPI_Type_commit");
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
    petsc_check(PetscSFCreate(PETSC_COMM_WORLD, &forest_), "PetscSFCreate");
    petsc_check(PetscSFSetGraph(forest_, own, static_cast<PetscInt>(leaves.size()), leaves.data(),
                                PETSC_COPY_VALUES, owners.data(), PETSC_COPY_VALUES),
                "PetscSFSetGraph");
    petsc_check(PetscSFSetUp(forest_), "PetscSFSetUp");
  }
  ~StarForestHalo() override { PetscSFDestroy(&forest_); }
  StarForestHalo(const StarForestHalo&) = delete;
  StarForestHalo& operator=(const StarForestHalo&) = delete;

  void exchange(void* values, std::size_t bytes) const override {
    const ValueType type(bytes);
    const auto* own = static_cast<const char*>(values) + static_cast<std::size_t>(first_) * bytes;
    petsc_check(PetscSFBcastBegin(forest_, type.get(), own, values, MPI_REPLACE),
                "PetscSFBcastBegin");
    petsc_check(PetscSFBcastEnd(forest_, type.get(), own, values, MPI_REPLACE), "PetscSFBcastEnd");
  }

 private:
  int first_;
  PetscSF forest_ = nullptr;
};

/// Throws where a message is too long for MPI.
int checked_int(std::size_t bytes) {
  if (bytes > std::numeric_limits<int>::max()) {
    throw std::runtime_error("ranks send each other more than 2 GB at once; take more ranks");
  }
  return static_cast<int>(bytes);
}

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    petsc_check(MPI_Comm_rank(PETSC_COMM_WORLD, &rank_), "MPI_Comm_rank");
    petsc_check(MPI_Comm_size(PETSC_COMM_WORLD, &count_), "MPI_Comm_size");
    petsc_check(MPI_Comm_dup(PETSC_COMM_WORLD, &endings_), "MPI_Comm_dup");
  }
  ~MpiRanks() override { MPI_Comm_free(&endings_); }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int count() const override { return count_; }

  void sum(const std::vector<ExactSum*>& sums) const override {
    std::vector<ExactSum> all;
    all.reserve(sums.size());
    for (const ExactSum* sum : sums) all.push_back(*sum);
    const ValueType type(sum_size);
    MPI_Op add = MPI_OP_NULL;
    petsc_check(MPI_Op_create(add_sums, 1, &add), "MPI_Op_create");
    petsc_check(MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), type.get(),
                              add, PETSC_COMM_WORLD),
                "MPI_Allreduce");
    petsc_check(MPI_Op_free(&add), "MPI_Op_free");
    for (std::size_t i = 0; i < sums.size(); ++i) *sums[i] = all[i];
  }

  void largest(std::span<double> values) const override {
    petsc_check(MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()),
                              MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD),
                "MPI_Allreduce");
  }

  [[nodiscard]] long before(long count) const override {
    long sum = 0;
    petsc_check(MPI_Exscan(&count, &sum, 1, MPI_LONG, MPI_SUM, PETSC_COMM_WORLD), "MPI_Exscan");
    return rank_ == 0 ? 0 : sum;
  }

  [[nodiscard]] std::string first_text(std::string own) const override {
    int first = own.empty() ? count_ : rank_;
    petsc_check(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD),
                "MPI_Allreduce");
    if (first == count_) return "";
    broadcast(first, own);
    return own;
  }

  [[nodiscard]] std::vector<std::uint8_t> of_first(std::vector<std::uint8_t> own) const override {
    broadcast(0, own);
    return own;
  }

  [[nodiscard]] std::vector<std::uint8_t> gather(std::vector<std::uint8_t> own) const override {
    const std::uint64_t size = own.size();
    std::vector<std::uint64_t> sizes(static_cast<std::size_t>(count_));
    petsc_check(
        MPI_Gather(&size, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, 0, PETSC_COMM_WORLD),
        "MPI_Gather");
    if (rank_ > 0) {
      for_pieces(size, [&](std::uint64_t at, int bytes) {
        petsc_check(MPI_Send(own.data() + at, bytes, MPI_BYTE, 0, 0, PETSC_COMM_WORLD), "MPI_Send");
      });
      return {};
    }
    // One rank after the other: rank 0 needs no memory but for what it gets.
    own.reserve(std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0}));
    for (int rank = 1; rank < count_; ++rank) {
      const std::uint64_t begin = own.size();
      const std::uint64_t coming = sizes[static_cast<std::size_t>(rank)];
      own.resize(begin + coming);
      for_pieces(coming, [&](std::uint64_t at, int bytes) {
        petsc_check(MPI_Recv(own.data() + begin + at, bytes, MPI_BYTE, rank, 0, PETSC_COMM_WORLD,
                             MPI_STATUS_IGNORE),
                    "MPI_Recv");
      });
    }
    return own;
  }

  [[nodiscard]] std::vector<std::uint8_t> send(
      const std::vector<std::vector<std::uint8_t>>& to) const override {
    std::vector<int> sizes;
    std::vector<int> begins;
    std::vector<std::uint8_t> out;
    for (const std::vector<std::uint8_t>& bytes : to) {
      sizes.push_back(checked_int(bytes.size()));
      begins.push_back(checked_int(out.size()));
      out.insert(out.end(), bytes.begin(), bytes.end());
    }
    std::vector<int> coming(sizes.size());
    petsc_check(MPI_Alltoall(sizes.data(), 1, MPI_INT, coming.data(), 1, MPI_INT, PETSC_COMM_WORLD),
                "MPI_Alltoall");
    std::vector<int> places;
    std::size_t all = 0;
    for (const int size : coming) {
      places.push_back(checked_int(all));
      all += static_cast<std::size_t>(size);
    }
    std::vector<std::uint8_t> in(static_cast<std::size_t>(checked_int(all)));
    petsc_check(MPI_Alltoallv(out.data(), sizes.data(), begins.data(), MPI_BYTE, in.data(),
                              coming.data(), places.data(), MPI_BYTE, PETSC_COMM_WORLD),
                "MPI_Alltoallv");
    return in;
  }

  [[nodiscard]] std::unique_ptr<SharedFactor> symmetric_factor() const override {
    return petsc_factor();
  }

  [[nodiscard]] bool all_come() const override {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::seconds patience{5};
    MPI_Request request = MPI_REQUEST_NULL;
    petsc_check(MPI_Ibarrier(endings_, &request), "MPI_Ibarrier");
    int have_come = 0;
    for (const auto start = Clock::now(); have_come == 0 && Clock::now() - start < patience;) {
      petsc_check(MPI_Test(&request, &have_come, MPI_STATUS_IGNORE), "MPI_Test");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return have_come != 0;
  }

  void end_all(int code) const override { MPI_Abort(PETSC_COMM_WORLD, code); }

  [[nodiscard]] OwnRows rows(const std::vector<long>& global, int first, int last) const override {
    // The first own row of each rank in the whole mesh. Ranks without own rows begin where the next
    // one does.
    const long start = before(last - first);
    std::vector<long> starts(static_cast<std::size_t>(count_));
    petsc_check(MPI_Allgather(&start, 1, MPI_LONG, starts.data(), 1, MPI_LONG, PETSC_COMM_WORLD),
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
  /// Calls `pass(at, bytes)` for pieces of so many bytes that MPI can count them.
  template <class Pass>
  static void for_pieces(std::uint64_t size, const Pass& pass) {
    constexpr std::uint64_t most = 1U << 30U;
    for (std::uint64_t at = 0; at < size; at += most) {
      pass(at, static_cast<int>(std::min(most, size - at)));
    }
  }

  /// Replaces bytes, text or numbers, by those of a rank.
  template <class Bytes>
  static void broadcast(int from, Bytes& bytes) {
    std::uint64_t size = bytes.size();
    petsc_check(MPI_Bcast(&size, 1, MPI_UINT64_T, from, PETSC_COMM_WORLD), "MPI_Bcast");
    bytes.resize(size);
    for_pieces(size, [&](std::uint64_t at, int count) {
      petsc_check(MPI_Bcast(bytes.data() + at, count, MPI_BYTE, from, PETSC_COMM_WORLD),
                  "MPI_Bcast");
    });
  }

  int rank_ = 0;
  int count_ = 1;
  MPI_Comm endings_ = MPI_COMM_NULL;  ///< for `all_come`, while other ranks talk of other things
};

}  // namespace

MpiProcess::MpiProcess() {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr) {
    // Open MPI without mpirun would start a daemon and look for networks, for one process.
    ::setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    ::setenv("OMPI_MCA_pml", "ob1", 0);
    ::setenv("OMPI_MCA_btl", "self", 0);
  } else {
    // A rank does not outlive mpirun. A process without mpirun may outlive its shell.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  }
  // One thread of each rank calls MPI, while another may write files.
  PETSC_MPI_THREAD_REQUIRED = MPI_THREAD_FUNNELED;
  petsc_check(PetscInitializeNoArguments(), "PetscInitialize");
  // Signals are the program's own.
  petsc_check(PetscPopSignalHandler(), "PetscPopSignalHandler");
}

MpiProcess::~MpiProcess() {
  PetscFinalize();
}

std::shared_ptr<const Ranks> mpi_ranks() {
  return std::make_shared<MpiRanks>();
}

}  // namespace suffuse
