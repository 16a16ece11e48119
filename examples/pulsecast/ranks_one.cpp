// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "ranks.hpp"

#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include "outputs.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;

namespace {

class OneLegRun final : public LegRun {
 public:
  OneLegRun(const fs::path& folder, const std::string& prefix, const Options& options, double start_time,
            const std::vector<std::string>& channels)
      : files_(folder, prefix, options, start_time, channels) {}
  void add_trajectory(const helios::SurveyLeg& leg, Tick start, double interval) override {
    files_.add_trajectory(leg, start, interval);
  }
  RunSummary run(const AnySurvey& survey, const RunOptions& options) override {
    return pulsecast::run(survey, options, *this);
  }
  void operator()(const EchoBatch& batch) {
    files_(batch);
    if (watch) watch(batch);
  }
  [[nodiscard]] bool reads_empty_shots() const noexcept {
    return files_.reads_empty_shots();
  }  ///< as the concept ChoosesShots describes
  void close() override { files_.close(); }
  [[nodiscard]] LeftOut left_out() const override { return files_.left_out(); }

 private:
  LegFiles files_;
};

/// Single process.
class OneRank final : public Ranks {
 public:
  [[nodiscard]] bool first() const override { return true; }
  [[nodiscard]] int count() const override { return 1; }
  [[nodiscard]] std::string from_first(std::string text) override { return text; }
  [[nodiscard]] unsigned threads(unsigned asked) override { return asked; }
  [[nodiscard]] std::unique_ptr<LegRun> leg_run(const fs::path& folder, const std::string& prefix,
                                                const Options& options, double start_time,
                                                const std::vector<std::string>& channels) override {
    return std::make_unique<OneLegRun>(folder, prefix, options, start_time, channels);
  }
  [[nodiscard]] std::string traffic() override { return {}; }
  void complain() override {}
  void abort(int) override {}

  [[nodiscard]] bool builds() const override { return true; }
  [[nodiscard]] bool shared() const override { return false; }
  [[nodiscard]] std::string from_builder(std::string text) override { return text; }
  void barrier() override {}
};

/// True if a launcher started several processes. Source: environment variables of Open MPI, MPICH and its relatives,
/// and Slurm with PMIx.
bool one_of_many() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

}  // namespace

std::unique_ptr<Ranks> join_ranks(char** argv) {
  if (one_of_many()) {
    std::error_code error;
    const fs::path other = fs::read_symlink("/proc/self/exe", error).parent_path() / "pulsecast-mpi";
    execv(other.c_str(), argv);
    throw std::runtime_error(
        "started by mpirun, but " + other.string() +
        " does not exist: build with MPI (Debian package: libopenmpi-dev), or start one process without mpirun");
  }
  return std::make_unique<OneRank>();
}
