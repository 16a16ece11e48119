// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <pulsecast/helios/scene.hpp>
#include <pulsecast/io/scene_cache.hpp>

#include "options.hpp"
#include "scene_sharing.hpp"

/// Parts of a scene, and its file, if there is one.
struct KeptParts {
  pulsecast::helios::BuiltParts built{};
  std::filesystem::path file{};
  pulsecast::io::Fingerprint key{};  ///< of the file
};

/// Builds the parts of a scene.
using BuildParts = std::function<pulsecast::helios::BuiltParts()>;

/// Inputs of a scene.
struct SceneInputs {
  std::set<std::filesystem::path> files{};  ///< files in the settings of the scene; `BuiltParts` has all
  std::vector<std::filesystem::path>
      more{};              ///< further files and folders; they do not count towards the size that is worth storing
  std::string settings{};  ///< all other inputs, as text
  std::string name{};      ///< for file names
  std::function<pulsecast::io::Fingerprint(const std::filesystem::path&)>
      content{};  ///< fingerprint of a file, zero for a missing one
};

/// Parts from `build`, or from an earlier build with equal inputs: scenes of large files are stored. Adds notes on the
/// store to `notes`. If the store fails, the scene is built.
KeptParts stored_parts(const SceneStore& store, const SceneInputs& inputs, const BuildParts& build,
                       std::vector<std::string>& notes);

/// Parts for all processes of a machine: one builds the scene, all map it from one file. A scene that is not stored is
/// in a mapped file, which is unlinked on return. If there is no room, each process builds the scene, with a note.
KeptParts shared_parts(SceneSharing& sharing, const SceneStore& store, const SceneInputs& inputs,
                       const BuildParts& build, std::vector<std::string>& notes);
