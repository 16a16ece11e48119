// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "survey_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <set>
#include <string>
#include <system_error>
#include <variant>

#include <pugixml.hpp>

#include <pulsecast/helios/document.hpp>
#include <pulsecast/io/output_file.hpp>

namespace fs = std::filesystem;
using namespace pulsecast;

SurveyFile read_survey_file(const Options& options, Notes& notes) try {
  helios::SurveyDocument document =
      helios::read_survey(options.survey, {.assets = options.assets, .channel_files = options.split_by_channel});
  notes.warn(document.warnings);
  std::string text = helios::xml_text(document.survey),
              scene_text = helios::xml_text(helios::AssetDocument{.scenes = {document.survey.scene}});
  return {std::move(document.survey), std::move(text), std::move(scene_text), std::move(document.leg_places),
          std::move(document.place)};
} catch (const helios::XmlFaults& faults) {
  notes.warn(faults.warnings());
  throw;
}

namespace {

/// Position of the `>` of the tag that begins at `from`.
std::size_t end_of_tag(const std::string& text, std::size_t from) {
  char quote = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (quote == 0 && text[i] == '>') return i;
    if (quote == 0 && (text[i] == '"' || text[i] == '\''))
      quote = text[i];
    else if (text[i] == quote)
      quote = 0;
  }
  return text.size();
}

/// Sets an attribute of the tag whose name begins at `tag`.
void set_attribute(std::string& text, std::size_t tag, const std::string& name, const std::string& value) {
  constexpr const char* blanks = " \t\r\n";
  const std::size_t end = end_of_tag(text, tag), name_end = text.find_first_of(" \t\r\n/>", tag);
  for (std::size_t at = name_end; at < end;) {
    at = text.find_first_not_of(blanks, at);
    const std::size_t equals = text.find('=', at);
    if (equals >= end) break;
    const std::size_t open = text.find_first_of("\"'", equals), close = text.find(text[open], open + 1);
    if (text.substr(at, text.find_last_not_of(blanks, equals - 1) + 1 - at) == name) {
      text.replace(open + 1, close - open - 1, value);
      return;
    }
    at = close + 1;
  }
  text.insert(name_end, ' ' + name + "=\"" + value + '"');
}

/// Target of a path through symbolic links.
fs::path target_of(fs::path path) {
  constexpr int max_links = 40;  // source: path_resolution(7)
  std::error_code error;
  for (int links = 0; links < max_links && fs::is_symlink(path, error); ++links)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

/// Throws a `FileError` unless a text, read at `path`, gives the same survey except for the change.
void require_same_survey(const Options& options, const SurveyFile& file, const WaveformChange& change,
                         const std::string& text, const fs::path& path) {
  struct Trial {
    fs::path path;
    ~Trial() {
      std::error_code ignored;
      fs::remove(path, ignored);
    }
  };
  const Trial trial{path.string() + ".part"};
  std::ofstream out(trial.path, std::ios::binary);
  if (!(out << text).flush()) throw FileError(path.string(), "", "cannot be written");
  const helios::SurveySettings written = helios::read_survey(trial.path, {.assets = options.assets}).survey;
  helios::SurveySettings wanted = file.survey;
  wanted.name = written.name;  // default name: that of the file
  for (helios::ChannelSettings& channel : wanted.scanner.channels) {
    channel.waveform.rings = change.rings;
    channel.waveform.bin_size = change.bin_size;
  }
  if (written != wanted) throw FileError(path.string(), "", "would be another survey; nothing is written");
}

}  // namespace

void write_survey_file(const Options& options, const SurveyFile& file, const WaveformChange& change,
                       const fs::path& path) {
  std::ifstream in(options.survey, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  pugi::xml_document document;
  if (!in || !document.load_buffer(text.data(), text.size()))
    throw FileError(options.survey.string(), "", "cannot be read again");
  const pugi::xml_node survey = document.document_element().child("survey"), waveforms = survey.child("FWFSettings");
  auto tag = static_cast<std::size_t>((waveforms ? waveforms : survey).offset_debug());
  if (!waveforms) {  // new element, indented like the next one
    const std::size_t end = end_of_tag(text, tag) + 1, next = text.find('<', end);
    const std::string before = text.substr(end, next - end) + "<";
    text.insert(end, before + "FWFSettings/>");
    tag = end + before.size();
  }
  set_attribute(text, tag, "binSize_ns", helios::xml_number(helios::units::nanosecond.number(change.bin_size)));
  set_attribute(text, tag, "beamSampleQuality", std::to_string(change.rings));

  require_same_survey(options, file, change, text, path);
  const fs::path target = target_of(path);
  io::OutputFile out(target);
  out.write(text);
  std::error_code error;
  if (const fs::file_status before = fs::status(target, error); fs::exists(before))
    fs::permissions(io::OutputFile::temporary_name(target), before.permissions(), error);
  else
    error.clear();
  if (error) throw FileError(path.string(), "", "cannot be given its former permissions: " + error.message());
  out.commit();
}

namespace {

const char* optic_name(const helios::OpticSettings& optic) {
  static constexpr const char* names[] = {"oscillating", "rotating", "conic", "line", "risley"};
  return names[optic.index()];
}

const char* kind_name(helios::PlatformKind kind) {
  static constexpr const char* names[] = {"static", "linearpath", "multicopter", "groundvehicle", "interpolated"};
  return names[static_cast<std::size_t>(kind)];
}

std::vector<fs::path> documents_of(const std::vector<fs::path>& folders) {
  std::vector<fs::path> files;
  std::set<std::string> seen;
  std::error_code ignored;
  const fs::path here_now = fs::current_path(ignored);  // documents of surveys
  for (const fs::path& folder : folders)
    for (const fs::path& inside : {folder, folder / "data"}) {
      if (inside == here_now) continue;
      std::error_code error;
      std::vector<fs::path> here;
      for (fs::directory_iterator i(inside, error), end; !error && i != end; i.increment(error))
        if (i->path().extension() == ".xml" && i->is_regular_file(error)) here.push_back(i->path());
      std::sort(here.begin(), here.end());
      for (fs::path& file : here)
        if (seen.insert(file.lexically_normal().string()).second) files.push_back(std::move(file));
    }
  return files;
}

}  // namespace

std::vector<CatalogueDocument> read_catalogue(const Options& options, const std::vector<fs::path>& folders) {
  std::vector<CatalogueDocument> all;
  for (fs::path& file : documents_of(folders)) try {
      helios::AssetDocument assets = helios::read_assets(file, {.assets = options.assets});
      if (!assets.scanners.empty() || !assets.platforms.empty()) all.push_back({std::move(file), std::move(assets)});
    } catch (const FileError& error) {
      if (options.verbose) std::cerr << "note: " << error.what() << '\n';
    }
  return all;
}

void print_catalogue(const Options& options) {
  for (const auto& [file, assets] : read_catalogue(options, options.assets)) {
    std::cout << file.string() << '\n';
    for (const auto& s : assets.scanners) {
      std::cout << "  " << std::left << std::setw(36) << s.id << std::setw(13) << optic_name(s.channels.front().optic)
                << std::right << std::setw(4) << s.channels.size()
                << (s.channels.size() == 1 ? " channel   " : " channels  ") << s.name << '\n';
    }
    for (const auto& p : assets.platforms)
      std::cout << "  " << std::left << std::setw(36) << p.id << std::setw(29) << kind_name(p.kind) << std::right
                << p.name << '\n';
  }
}
