// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "outputs.hpp"

#include <algorithm>
#include <optional>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include <pulsecast/io/copc.hpp>
#include <pulsecast/io/geojson.hpp>
#include <pulsecast/io/gzip.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/io/laz.hpp>
#include <pulsecast/io/misses.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/io/text_files.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/shape/hillshade.hpp>

namespace fs = std::filesystem;
using namespace pulsecast;

namespace {

using PointWriter = std::variant<io::XyzWriter, io::LasWriter, io::LazWriter, io::CopcWriter>;

PointWriter point_writer(const fs::path& path, const Options& o, double start_time) {
  if (o.format == "copc.laz")
    return PointWriter(std::in_place_type<io::CopcWriter>, path, las_settings(o, start_time), o.threads);
  if (o.format == "laz")
    return PointWriter(std::in_place_type<io::LazWriter>, path, las_settings(o, start_time), o.threads);
  if (o.format == "las") return PointWriter(std::in_place_type<io::LasWriter>, path, las_settings(o, start_time));
  const io::TextFileSettings text{.start_time = start_time};
  if (o.format == "xyz.gz")
    return PointWriter(std::in_place_type<io::XyzWriter>, io::gzip_file(path), text, text_columns(o));
  return PointWriter(std::in_place_type<io::XyzWriter>, path, text, text_columns(o));
}

}  // namespace

void take_columns(Options& o, const helios::Simulation& simulation) {
  o.points = simulation.points();
  if (o.colours) o.point_colours = o.points.colours;
  o.attributes = std::make_shared<const ObjectAttributes>(o.points.attributes);
  if (o.attributes->empty()) o.attributes.reset();
  o.fields = io::layouts::columns(o.columns, o.points.attributes.names());
}

io::PointTextColumns text_columns(const Options& o) { return {o.fields, o.points}; }

std::vector<std::string> file_channels(const Options& o, const helios::SurveySettings& survey) {
  std::vector<std::string> ids;
  if (o.split_by_channel && survey.scanner.channels.size() > 1)
    for (const auto& channel : survey.scanner.channels)
      ids.push_back(channel.id.empty() ? std::to_string(ids.size()) : channel.id);
  return ids;
}

std::string prefix_of(const helios::CompiledSurvey::Leg& leg) {
  if (leg.strip) return "strip" + std::string(3 - std::min<std::size_t>(3, leg.strip->size()), '0') + *leg.strip;
  const std::string number = std::to_string(leg.number);
  return "leg" + std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number;
}

std::vector<fs::path> point_files(const fs::path& folder, const std::string& prefix, const Options& o,
                                  const std::vector<std::string>& channels) {
  if (channels.empty()) return {folder / (prefix + "_points." + o.format)};
  std::vector<fs::path> all;
  for (const std::string& channel : channels)
    all.push_back(folder / (prefix + "_points_dev" + channel + '.' + o.format));
  return all;
}

std::vector<fs::path> leg_files(const fs::path& folder, const std::string& prefix, const Options& o,
                                const std::vector<std::string>& channels) {
  std::vector<fs::path> all;
  for (const fs::path& points : point_files(folder, prefix, o, channels)) {
    all.push_back(points);
    if (las_settings(o, 0).waveforms) all.push_back(fs::path(points).replace_extension(".wdp"));
  }
  all.push_back(folder / (prefix + "_trajectory.txt"));
  if (o.write_waveform) all.push_back(folder / (prefix + "_fullwave.txt"));
  if (o.write_pulse) all.push_back(folder / (prefix + "_pulse.txt"));
  if (o.write_misses) all.push_back(folder / (prefix + "_misses.txt"));
  if (o.geojson) all.push_back(folder / (prefix + "_map.geojson"));
  return all;
}

io::LasSettings las_settings(const Options& o, double start_time) {
  io::LasSettings settings{.scale = o.las_scale,
                           .gps_time = o.adjusted_time ? io::GpsTime::adjusted_standard : io::GpsTime::week,
                           .start_time = start_time};
  settings.reference = o.reference.value_or(io::SpatialReference{});
  settings.light_kinds = o.light_paths;
  settings.colours = o.point_colours;
  settings.near_infrared = o.near_infrared && o.point_colours;
  settings.attributes = o.attributes;
  for (const io::PointField& field : o.fields)
    if (field.column != &io::attribute_column) settings.columns.push_back(field);  // LAS has all attributes
  settings.points = o.points;
  if (o.format == "las" && o.las_1_0) settings.format = io::LasFormat::las_1_0;
  settings.waveforms = o.format == "las" && o.write_waveform && !o.las_1_0;
  return settings;
}

struct LegFiles::Inside {
  std::vector<PointWriter> points;
  io::TrajectoryWriter trajectory;
  std::optional<io::WaveformTextWriter> waveforms;
  std::optional<io::PulseTextWriter> pulses;
  std::optional<io::MissTextWriter> misses;
  std::optional<io::MissPoints> miss_points;
  std::optional<io::GeoJsonWriter> map;
  std::vector<Shot> shots;
};

LegFiles::LegFiles(const fs::path& folder, const std::string& prefix, const Options& o, double start_time,
                   const std::vector<std::string>& channels)
    : inside_(new Inside{{},
                         io::TrajectoryWriter(folder / (prefix + "_trajectory.txt"), {.start_time = start_time}),
                         {},
                         {},
                         {},
                         {},
                         {},
                         {}}) {
  for (const fs::path& path : point_files(folder, prefix, o, channels))
    inside_->points.push_back(point_writer(path, o, start_time));
  if (o.write_waveform)
    inside_->waveforms.emplace(folder / (prefix + "_fullwave.txt"), io::TextFileSettings{start_time});
  if (o.write_pulse) inside_->pulses.emplace(folder / (prefix + "_pulse.txt"), io::TextFileSettings{start_time});
  if (o.write_misses) inside_->misses.emplace(folder / (prefix + "_misses.txt"), io::TextFileSettings{start_time});
  if (o.misses_at) inside_->miss_points.emplace(io::MissSettings{.range = *o.misses_at});
  if (o.geojson) {
    const io::SpatialReference in = o.reference.value_or(io::SpatialReference{});
    inside_->map.emplace(folder / (prefix + "_map.geojson"),
                         io::GeoJsonSettings{.epsg = in.epsg, .unit = in.unit, .vertical_unit = in.vertical_unit});
  }
}
LegFiles::~LegFiles() = default;

void LegFiles::operator()(const EchoBatch& batch) {
  const EchoBatch points = inside_->miss_points ? (*inside_->miss_points)(batch) : batch;
  for (std::size_t k = 0; k < inside_->points.size(); ++k) {
    EchoBatch part = points;
    if (inside_->points.size() > 1) {
      inside_->shots.clear();
      for (const Shot& shot : points.shots)
        if (shot.channel == k) inside_->shots.push_back(shot);
      part.shots = inside_->shots;
    }
    std::visit([&](auto& writer) { writer(part); }, inside_->points[k]);
  }
  if (inside_->waveforms) (*inside_->waveforms)(batch);
  if (inside_->pulses) (*inside_->pulses)(batch);
  if (inside_->misses) (*inside_->misses)(batch);
  if (inside_->map) (*inside_->map)(batch);
}

bool LegFiles::reads_empty_shots() const noexcept {
  return inside_->pulses || inside_->misses || inside_->miss_points || inside_->map;
}

void LegFiles::add_trajectory(const helios::SurveyLeg& leg, Tick start, double interval) {
  if (interval > 0) inside_->trajectory.add(leg.path(), start, leg.recorded(), interval);
}

void LegFiles::close() {
  if (inside_->waveforms) inside_->waveforms->close();
  if (inside_->pulses) inside_->pulses->close();
  if (inside_->misses) inside_->misses->close();
  if (inside_->map) inside_->map->close();
  inside_->trajectory.close();
  for (PointWriter& writer : inside_->points) std::visit([](auto& w) { w.close(); }, writer);
}

std::uint64_t LegFiles::pulses_cut() const {
  std::uint64_t sum = 0;
  for (const PointWriter& writer : inside_->points)
    std::visit(
        [&]<class Writer>(const Writer& w) {
          if constexpr (!std::is_same_v<Writer, io::XyzWriter>) sum += w.pulses_cut();
        },
        writer);
  return sum;
}

struct Picture::Inside {
  io::ImageWriter writer;
};
Picture::Picture(const fs::path& path) : inside_(new Inside{io::ImageWriter(path)}) {}
Picture::~Picture() = default;
void Picture::operator()(const EchoBatch& batch) { inside_->writer(batch); }
void Picture::add_ground(const Raster& raster, const Placement& placement) {
  inside_->writer.add_ground(raster, hillshade(raster), placement);
}
void Picture::close() { inside_->writer.close(); }
