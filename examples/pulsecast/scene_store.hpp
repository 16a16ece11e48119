// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <pulsecast/helios/make_simulation.hpp>
#include <pulsecast/io/digest.hpp>

#include "options.hpp"
#include "scene_sharing.hpp"

/// The parts of a scene, and the file that they stand in as well, if there is one.
struct KeptParts {
  pulsecast::helios::BuiltParts built{};
  std::filesystem::path file{};
  pulsecast::io::Fingerprint key{};  ///< of the file
};

/// Builds the parts of a scene.
using BuildParts = std::function<pulsecast::helios::BuiltParts()>;

/// What a scene depends on.
struct SceneInputs {
  std::vector<std::filesystem::path> files{};  ///< the scene's own
  std::vector<std::filesystem::path> more{};   ///< files and folders that count as well, and are not worth a store by themselves
  std::string settings{};                      ///< all else, in words
  std::string name{};                          ///< for people
  std::function<pulsecast::io::Fingerprint(const std::filesystem::path&)> content = pulsecast::io::content_fingerprint;  ///< of them
};

/// What `build` makes, or what it made of the same inputs before, if that is kept: scenes of large files are. Notes, for those who want to
/// know of it, are added to `notes`. Whatever goes wrong with the store, the scene is built.
KeptParts stored_parts(const SceneStore& store, const SceneInputs& inputs, const BuildParts& build, std::vector<std::string>& notes);

/// The same for all processes of a machine: one builds the scene, and all map it from one file. What is not kept stands in memory as a file
/// that has no name any more when this returns. Where there is no room for it, each builds the scene for itself, and a note says so.
KeptParts shared_parts(SceneSharing& sharing, const SceneStore& store, const SceneInputs& inputs, const BuildParts& build,
                       std::vector<std::string>& notes);
