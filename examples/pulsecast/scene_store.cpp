// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "scene_store.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <random>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <pulsecast/base/text.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/output_file.hpp>
#include <pulsecast/io/scene_cache.hpp>

#include "survey_inputs.hpp"
#include "written_name.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;
using helios::SurveyScene;
using io::Fingerprint;

namespace {

constexpr std::uintmax_t worth_keeping =
    std::uintmax_t{16} << 20;  ///< minimum size of the scene's files; smaller scenes build in about a second [byte]
constexpr std::uintmax_t max_kept = std::uintmax_t{16} << 30;  ///< of all scenes except the newest [byte]

/// Identifies this program and the one that it starts for foreign meshes: another build may make other scenes.
std::string this_program() {
  std::error_code error;
  fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (program.filename() == "pulsecast-mpi") program.replace_filename("pulsecast");  // same objects
  std::string all;
  for (const fs::path& one : {program, program.parent_path() / "pulsecast-import"}) {
    const auto size = fs::file_size(one, error);
    if (error) continue;
    all +=
        std::to_string(size) + ' ' + std::to_string(fs::last_write_time(one, error).time_since_epoch().count()) + ' ';
  }
  return all;
}

/// Name of a scene in the store. It does not depend on file contents, so that changes replace the scene.
std::string place_of(const SceneInputs& inputs) {
  io::Digest digest;
  digest.add(std::string_view(inputs.settings));
  std::error_code error;
  for (const fs::path& file : inputs.files) digest.add(std::string_view(fs::absolute(file, error).string()));
  std::string name = inputs.name.substr(0, 40);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name + '-' + hex(digest.value().low);
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) lines.emplace_back(text::take_line(text));
  return lines;
}

/// Notes on a scene in the store, in a file of their own.
struct SceneNotes {
  Fingerprint key{};           ///< of the scene
  std::set<fs::path> files{};  ///< that its builder looked for
  std::vector<std::string> warnings{};

  void write(const fs::path& path) const {
    io::OutputFile file(path);
    file.write(hex(key) + '\n' + std::to_string(files.size()) + '\n');
    for (const fs::path& one : files) file.write(written_name(one.string()) + '\n');
    for (const std::string& warning : warnings) file.write(warning + '\n');
    file.write(std::string_view("end\n"));
    file.commit();
  }

  /// Notes whose key is that of their files, by `key_of`.
  template <class KeyOf>
  [[nodiscard]] static std::optional<SceneNotes> read(const fs::path& path, const KeyOf& key_of) try {
    const std::vector<std::string> lines = lines_of(io::InputFile(path, "notes on a scene").take_rest());
    if (lines.size() < 3 || lines.back() != "end") return std::nullopt;
    const auto count = text::number_in<std::size_t>(lines[1]);
    if (!count || *count > lines.size() - 3) return std::nullopt;
    const auto first = lines.begin() + 2, last = first + static_cast<std::ptrdiff_t>(*count);
    SceneNotes notes{.warnings = {last, lines.end() - 1}};
    for (auto line = first; line != last; ++line) notes.files.insert(name_written(*line));
    notes.key = key_of(notes.files);
    return lines.front() == hex(notes.key) ? std::optional(std::move(notes)) : std::nullopt;
  } catch (const FileError&) {
    return std::nullopt;
  }
};

/// Replaces a file atomically: `write` makes it under a unique name, so that programs that start at the same time do no
/// harm.
template <class Write>
void replace(const fs::path& path, const Write& write) {
  const fs::path own = path.string() + '.' + hex(std::uint64_t{std::random_device{}()} << 32 | std::random_device{}());
  write(own);
  std::error_code error;
  fs::rename(own, path, error);
  if (!error) return;
  std::error_code ignored;
  fs::remove(own, ignored);
  throw FileError(path.string(), "", "cannot be replaced: " + error.message());
}

/// Removes the least recently used scenes until the others fit into `max_kept`.
void tidy(const fs::path& folder, const fs::path& newest) {
  struct Kept {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t size;
  };
  std::vector<Kept> all;
  std::uintmax_t sum = 0;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    std::error_code gone;
    Kept kept{i->path(), i->last_write_time(gone), i->file_size(gone)};
    if (gone || kept.path == newest) continue;
    sum += kept.size;
    all.push_back(std::move(kept));
  }
  std::sort(all.begin(), all.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (const Kept& kept : all) {
    if (sum <= max_kept) break;
    std::error_code ignored;
    if (fs::remove(kept.path, ignored)) sum -= kept.size;
  }
}

std::uintmax_t size_of(const std::set<fs::path>& files) {
  std::uintmax_t size = 0;
  for (const fs::path& file : files) {
    std::error_code error;
    const std::uintmax_t one = fs::file_size(file, error);
    size += error ? 0 : one;
  }
  return size;
}

}  // namespace

KeptParts stored_parts(const SceneStore& store, const SceneInputs& inputs, const BuildParts& build,
                       std::vector<std::string>& notes) {
  if (store.folder.empty() || (!store.read && !store.write)) return {.built = build()};
  const fs::path path = store.folder / (place_of(inputs) + ".scene"),
                 notes_path = fs::path(path).replace_extension(".notes");
  const std::string program = this_program();
  const auto key_of = [&](const std::set<fs::path>& looked_for) {
    std::set<fs::path> all = inputs.files;
    all.insert(looked_for.begin(), looked_for.end());
    io::SceneSources sources{{all.begin(), all.end()}, inputs.settings + program};
    sources.files.insert(sources.files.end(), inputs.more.begin(), inputs.more.end());
    return io::scene_key(sources, inputs.content);
  };
  if (store.read) {
    auto known = SceneNotes::read(notes_path, key_of);
    auto opened = known ? io::open_scene<SurveyScene>(path, known->key, MovingIndexSettings{.to = 1})
                        : io::OpenedScene<SurveyScene>{};
    if (opened.scene) {
      std::error_code ignored;
      for (const fs::path& used : {path, notes_path})
        fs::last_write_time(used, fs::file_time_type::clock::now(), ignored);
      notes.push_back("the scene is read from its cache, " + path.string());
      return {{{opened.scene->parts().begin(), opened.scene->parts().end()},
               std::move(known->warnings),
               std::move(known->files)},
              path,
              known->key};
    }
  }
  for (const fs::path& file : inputs.files) (void)inputs.content(file);  // so that a change during the build is noticed
  KeptParts made{.built = build()};
  if (!store.write) return made;
  try {
    if (size_of(made.built.files) < worth_keeping) return made;
    const Fingerprint key = key_of(made.built.files);
    std::error_code error;
    fs::create_directories(store.folder, error);
    if (error) throw FileError(store.folder.string(), "", "the folder cannot be created: " + error.message());
    const SurveyScene scene(made.built.parts, MovingIndexSettings{.to = 1});
    const std::uintmax_t room = fs::space(store.folder, error).available;
    if (scene.memory() > (error ? max_kept : std::min(max_kept, room)) / 2)
      throw FileError(store.folder.string(), "", "the scene is too large for this folder");
    replace(notes_path, [&](const fs::path& own) {
      SceneNotes{key, made.built.files, made.built.warnings}.write(own);
    });
    replace(path, [&](const fs::path& own) { io::save_scene(own, scene, key); });
    tidy(store.folder, path);
    notes.push_back("the scene is cached for the next run in " + path.string());
    made.file = path;
    made.key = key;
  } catch (const FileError& error) {
    notes.push_back(std::string("the scene is not cached: ") + error.what());
  }
  return made;
}

namespace {

/// Writes a scene to a temporary file, in memory if there is room. No file if there is no room at all.
void keep_for_now(KeptParts& kept) {
  const std::uint64_t mark = std::uint64_t{std::random_device{}()} << 32 | std::random_device{}();
  std::error_code ignored;
  for (const fs::path& folder : {fs::path("/dev/shm"), fs::temp_directory_path(ignored)}) try {
      const SurveyScene scene(kept.built.parts, MovingIndexSettings{.to = 1});
      std::error_code error;
      const std::uintmax_t room = fs::space(folder, error).available;
      if (error || room < scene.memory() + (scene.memory() >> 3)) continue;
      const fs::path path = folder / ("pulsecast-" + hex(mark) + ".scene");
      kept.key = {mark, ~mark};
      io::save_scene(path, scene, kept.key);
      kept.file = path;
      return;
    } catch (const FileError&) {  // there may be room elsewhere
    }
}

}  // namespace

KeptParts shared_parts(SceneSharing& sharing, const SceneStore& store, const SceneInputs& inputs,
                       const BuildParts& build, std::vector<std::string>& notes) {
  KeptParts kept;
  if (sharing.builds()) kept = stored_parts(store, inputs, build, notes);
  if (!sharing.shared()) return kept;
  bool for_now = false;
  if (sharing.builds() && kept.file.empty()) {
    keep_for_now(kept);
    for_now = !kept.file.empty();
  }
  const std::string path = sharing.from_builder(kept.file.string());
  const std::string key = sharing.from_builder(std::string(reinterpret_cast<const char*>(&kept.key), sizeof kept.key));
  std::string warnings;
  for (const std::string& warning : kept.built.warnings) warnings += warning + '\n';
  warnings = sharing.from_builder(std::move(warnings));

  std::memcpy(&kept.key, key.data(), sizeof kept.key);
  std::string reason = "too little free space for a file of it";
  if (!path.empty()) {  // the builder drops its own copy for this one
    auto opened = io::open_scene<SurveyScene>(path, kept.key, MovingIndexSettings{.to = 1});
    reason = opened.reason;
    if (opened.scene) kept.built.parts.assign(opened.scene->parts().begin(), opened.scene->parts().end());
  }
  if (kept.built.parts.empty()) kept = {.built = build()};
  kept.built.warnings = lines_of(warnings);
  if (!reason.empty()) notes.push_back("each process has a scene of its own: " + reason);
  sharing.barrier();
  if (for_now) {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
  return kept;
}
