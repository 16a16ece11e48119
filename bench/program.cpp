// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The survey program as a process: time and memory of its start, and of a survey of 1.2 million slots along a street of
// some 50,000 triangles, 19 subrays a pulse, to LAS, without a cached scene. Usage: bench_program PROGRAM. The survey
// and its scene are written to the system's folder for temporary files by a process of their own, as a child starts
// with the greatest memory of its parent, and removed.

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "report.hpp"
#include "scenes.hpp"

using namespace bench;

namespace {

constexpr std::string_view survey = R"(<?xml version="1.0"?>
<document>
<platform id="car" name="car" type="linearpath"><scannerMount z="2.3"/></platform>
<scanner id="mirror" name="mirror" optics="rotating" pulseFreqs_Hz="300000" pulseLength_ns="5"
 beamDivergence_rad="0.0003" scanFreqMin_Hz="1" scanFreqMax_Hz="200" scanAngleMax_deg="180"
 wavelength_nm="905" averagePower_w="4"/>
<scene id="street"><part><filter type="objloader">
<param type="string" key="filepath" value="street.obj"/></filter></part></scene>
<survey name="street" scene="street.xml#street" platform="street.xml#car" scanner="street.xml#mirror">
<FWFSettings beamSampleQuality="3"/>
<leg><platformSettings x="2" y="-20" movePerSec_m="10"/>
<scannerSettings active="true" pulseFreq_hz="300000" scanFreq_hz="100" scanAngle_deg="60"/></leg>
<leg><platformSettings x="2" y="20"/><scannerSettings active="false"/></leg>
</survey>
</document>
)";

/// Writes the street as OBJ, each corner once, and its survey.
int write(const std::filesystem::path& folder) {
  const MeshData mesh = flattened(street::scene(1));
  std::ofstream obj(folder / "street.obj");
  std::map<std::array<double, 3>, std::size_t> numbers;
  std::vector<std::size_t> number_of;
  for (const Vec3& v : mesh.vertices) {
    const auto [entry, is_new] = numbers.try_emplace({v.x, v.y, v.z}, numbers.size() + 1);
    if (is_new) obj << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
    number_of.push_back(entry->second);
  }
  for (const auto& corners : mesh.triangles)
    obj << "f " << number_of[corners[0]] << ' ' << number_of[corners[1]] << ' ' << number_of[corners[2]] << '\n';
  std::ofstream(folder / "street.xml") << survey;
  return obj ? 0 : 1;
}

/// What a process took.
struct Taken {
  double wall, processor, megabytes;
};

Taken start(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  int status = 0;
  rusage usage{};
  const double began = wall_seconds();
  if (posix_spawn(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ) != 0 ||
      wait4(child, &status, 0, &usage) != child || status != 0) {
    std::printf("%s fails\n", words[0].c_str());
    std::exit(1);
  }
  posix_spawn_file_actions_destroy(&actions);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {wall_seconds() - began, seconds(usage.ru_utime) + seconds(usage.ru_stime),
          static_cast<double>(usage.ru_maxrss) / 1000};
}

void measure(Report& report, const std::string& name, int rounds, const std::vector<std::string>& words) {
  if (!report.wanted(name)) return;
  Times wall, processor, memory;
  for (int round = 0; round < rounds; ++round) {
    const Taken taken = start(words);
    wall.push_back(1000 * taken.wall);
    processor.push_back(1000 * taken.processor);
    memory.push_back(taken.megabytes);
  }
  report.row(name, {{"ms", median(wall)}, {"ms of processors", median(processor)}, {"MB", median(memory)}});
}

}  // namespace

int main(int count, char** words) {
  if (count == 3 && std::string_view(words[1]) == "--write") return write(words[2]);
  Report report("program", count, words);
  if (report.files().empty()) {
    std::printf("usage: bench_program PROGRAM\n");
    return 2;
  }
  const std::string program = std::filesystem::absolute(report.files()[0]);
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "pulsecast_bench_program";
  std::filesystem::create_directories(folder);
  start({"/proc/self/exe", "--write", folder});
  std::filesystem::current_path(folder);
  setenv("XDG_CACHE_HOME", folder.c_str(), 1);
  report.heading("processes");
  measure(report, "--version", 10 * report.rounds(), {program, "--version"});
  measure(
      report, "street to LAS", report.rounds(),
      {program, "street.xml", "--quiet", "--seed", "1", "--format", "las", "--output", "out", "--no-scene-writing"});
  std::filesystem::current_path("/");
  std::filesystem::remove_all(folder);
}
