// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <pulsecast/helios/scene.hpp>
#include <pulsecast/io/digest.hpp>

#include "options.hpp"

/// The parts of a scene, and what was odd about them.
struct BuiltParts {
  std::vector<pulsecast::helios::SurveyPart> parts;
  std::vector<std::string> warnings;
  std::filesystem::path kept{};      ///< the file that they stand in as well, if there is one
  pulsecast::io::Fingerprint key{};  ///< of that file
};

/// What a scene depends on.
struct SceneInputs {
  std::vector<std::filesystem::path> files{};  ///< the scene's own
  std::vector<std::filesystem::path> more{};   ///< files and folders that count as well, and are not worth a store by themselves
  std::string settings{};                      ///< all else, in words
  std::string name{};                          ///< for people
  std::function<pulsecast::io::Fingerprint(const std::filesystem::path&)> content = pulsecast::io::content_fingerprint;  ///< of them
};

/// The processes of one machine, which have one copy of a scene among them.
class SceneSharing {
 public:
  virtual ~SceneSharing() = default;
  [[nodiscard]] virtual bool builds() const = 0;  ///< whether this is the one that builds it
  [[nodiscard]] virtual bool shared() const = 0;  ///< whether there are others
  /// What the one that builds says, by all.
  [[nodiscard]] virtual std::string from_builder(std::string text) = 0;
  /// Waits until all have come here.
  virtual void barrier() = 0;
};

/// What `build` makes, or what it made of the same inputs before, if that is kept: scenes of large files are. Notes, for those who want to
/// know of it, are added to `notes`. Whatever goes wrong with the store, the scene is built.
BuiltParts stored_parts(const SceneStore& store, const SceneInputs& inputs, const std::function<BuiltParts()>& build,
                        std::vector<std::string>& notes);

/// The same for all processes of a machine: one builds the scene, and all map it from one file. What is not kept stands in memory as a file
/// that has no name any more when this returns. Where there is no room for it, each builds the scene for itself, and a note says so.
BuiltParts shared_parts(SceneSharing& sharing, const SceneStore& store, const SceneInputs& inputs, const std::function<BuiltParts()>& build,
                        std::vector<std::string>& notes);
