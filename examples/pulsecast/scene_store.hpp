// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <pulsecast/adapters/scene_builder.hpp>

#include "options.hpp"

/// The parts of a scene, and what was odd about them.
struct BuiltParts {
  std::vector<pulsecast::adapters::SurveyPart> parts;
  std::vector<std::string> warnings;
};

/// What a scene depends on.
struct SceneInputs {
  std::vector<std::filesystem::path> files{};  ///< the scene's own
  std::vector<std::filesystem::path> more{};   ///< files and folders that count as well, and are not worth a store by themselves
  std::string settings{};                      ///< all else, in words
  std::string name{};                          ///< for people
};

/// What `build` makes, or what it made of the same inputs before, if that is kept: scenes of large files are. Notes, for those who want to
/// know of it, are added to `notes`. Whatever goes wrong with the store, the scene is built.
BuiltParts stored_parts(const SceneStore& store, const SceneInputs& inputs, const std::function<BuiltParts()>& build,
                        std::vector<std::string>& notes);
