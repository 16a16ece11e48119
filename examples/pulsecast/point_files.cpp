// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "point_files.hpp"

#include <algorithm>
#include <concepts>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <pulsecast/base/text.hpp>
#include <pulsecast/io/copc.hpp>
#include <pulsecast/io/gzip.hpp>
#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/kitti.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/io/laz.hpp>
#include <pulsecast/io/ply.hpp>
#include <pulsecast/io/ptx.hpp>
#include <pulsecast/io/text_files.hpp>
#ifdef PULSECAST_PCD
#include <pulsecast/io/pcd.hpp>
#endif
#ifdef PULSECAST_ROS
#include <pulsecast/io/mcap.hpp>
#include <pulsecast/io/point_cloud2.hpp>
#include <pulsecast/io/scan_splitter.hpp>
#endif

#include "outputs.hpp"
#include "parts.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;

void LeftOut::add(const LeftOut& other) {
  pulses_cut += other.pulses_cut;
  classes_cut += other.classes_cut;
  echoes += other.echoes;
  waveforms_cut += other.waveforms_cut;
  samples_max = std::max(samples_max, other.samples_max);
  for (const auto& [number, points] : other.unlabelled) unlabelled[number] += points;
}

std::vector<std::string> LeftOut::notes(bool las_1_0) const {
  const auto number = [](std::uint64_t count) { return std::to_string(count); };
  std::vector<std::string> all;
  if (pulses_cut > 0)
    all.push_back(
        number(pulses_cut) + " pulses have more than " + (las_1_0 ? "5" : "15") +
        " returns, the greatest number in LAS, which later ones have, too: maxNOR of the scanner limits them");
  if (classes_cut > 0)
    all.push_back(number(classes_cut) + " points have a class above " + (las_1_0 ? "31" : "255") +
                  ", the greatest in LAS, which they have, too: --columns classification keeps theirs");
  if (echoes > 0)
    all.push_back(number(echoes) +
                  " points have no place in PTX, which has the first return of a pulse in the grid: --format npz or "
                  "laz has all");
  if (waveforms_cut > 0)
    all.push_back(number(waveforms_cut) + " waveforms have more samples than --waveformBins, up to " +
                  number(samples_max) + ": the rest is left out");
  std::string classes;
  std::uint64_t points = 0;
  for (const auto& [of, count] : unlabelled) {
    classes += (classes.empty() ? "" : ", ") + std::to_string(of);
    points += count;
  }
  if (points > 0)
    all.push_back(number(points) + " points have label 0, as no label is known of their classes (" + classes +
                  "): --kittiClasses gives labels");
  return all;
}

namespace {

template <class Writer>
void count_left_out(const Writer& /*writer*/, LeftOut& /*sum*/) {}
template <class Writer>
concept WritesLas =
    std::same_as<Writer, io::LasWriter> || std::same_as<Writer, io::LazWriter> || std::same_as<Writer, io::CopcWriter>;
template <WritesLas Writer>
void count_left_out(const Writer& writer, LeftOut& sum) {
  sum.add({.pulses_cut = writer.pulses_cut(), .classes_cut = writer.classes_cut()});
}
void count_left_out(const io::KittiWriter& writer, LeftOut& sum) { sum.add({.unlabelled = writer.unlabelled()}); }
void count_left_out(const io::PtxWriter& writer, LeftOut& sum) { sum.add({.echoes = writer.echoes_left_out()}); }

template <class Writer>
class CountedFile final : public WrittenFile<Writer> {
 public:
  using WrittenFile<Writer>::WrittenFile;
  void count(LeftOut& sum) const override { count_left_out(this->writer_, sum); }
};

template <class Writer, class... Arguments>
std::unique_ptr<PointFile> written(Arguments&&... arguments) {
  return std::make_unique<CountedFile<Writer>>(std::forward<Arguments>(arguments)...);
}

/// Settings of points in the frame of the scanner, in scans.
io::PointSettings in_scans(const Options& o, const std::string& prefix, double start_time) {
  io::PointSettings points = o.points;
  points.start_time = start_time;
  points.sensor = o.sensors.at(prefix);
  return points;
}

#ifdef PULSECAST_ROS
/// Scans as messages of ROS 2 on the topic /points.
class ScanMessages {
 public:
  ScanMessages(const fs::path& path, const Options& o, io::PointSettings points)
      : bag_(path),
        channel_(bag_.add_channel(
            {.topic = "/points", .schema_name = io::point_cloud2_type, .schema = io::point_cloud2_definition})),
        scans_(io::PointBuffer(point_layout(o), turned(std::move(points))), o.scan_rate,
               [this](const io::PointBuffer& scan) {
                 io::serialize_point_cloud2(scan, "scanner", message_);
                 bag_.write(channel_, io::stamp_ns(scan), io::stamp_ns(scan), message_);
               }) {}
  void operator()(const EchoBatch& batch) { scans_(batch); }
  void close() {
    scans_.close();
    bag_.close();
  }

 private:
  static io::PointSettings turned(io::PointSettings points) {
    points.axes = io::PointAxes::forward_left_up;
    return points;
  }

  io::McapWriter bag_;
  std::uint16_t channel_;
  std::vector<std::byte> message_;
  io::ScanSplitter scans_;
};
#endif

io::KittiSettings kitti_settings(const std::string& prefix, const Options& o, double start_time) {
  io::KittiSettings settings{.scan_rate = o.scan_rate, .points = in_scans(o, prefix, start_time)};
  settings.points.distortion = io::MotionDistortion::removed;
  if (!o.kitti_classes.empty()) settings.classes = read_kitti_classes(o.kitti_classes);
  return settings;
}

}  // namespace

std::unique_ptr<PointFile> point_file(const fs::path& path, const std::string& prefix, const Options& o,
                                      double start_time) {
  if (o.format == "copc.laz") return written<io::CopcWriter>(path, las_settings(o, start_time), o.threads);
  if (o.format == "laz") return written<io::LazWriter>(path, las_settings(o, start_time), o.threads);
  if (o.format == "las") return written<io::LasWriter>(path, las_settings(o, start_time));
  if (o.format == "kitti") return written<io::KittiWriter>(path, kitti_settings(prefix, o, start_time));
  if (o.format == "ptx") return written<io::PtxWriter>(path, o.ptx_scans.at(prefix));
  io::PointSettings points = o.points;
  points.start_time = start_time;
  if (o.format == "ply")
    return written<io::PlyWriter>(path, io::PlySettings{.layout = point_layout(o), .points = points});
  if (o.format == "npz") return part<ArraysPart>().points(path, point_layout(o), points);
#ifdef PULSECAST_PCD
  points.origin = o.origin;
  if (o.format == "pcd")
    return written<io::PcdWriter>(path, io::PcdSettings{.layout = point_layout(o), .points = points});
#endif
#ifdef PULSECAST_ROS
  if (o.format == "mcap") return written<ScanMessages>(path, o, in_scans(o, prefix, start_time));
#endif
  const io::TextFileSettings text{.start_time = start_time};
  if (o.format == "xyz.gz") return written<io::XyzWriter>(io::gzip_file(path), text, text_columns(o));
  return written<io::XyzWriter>(path, text, text_columns(o));
}

io::KittiClasses read_kitti_classes(const fs::path& path) {
  io::KittiClasses classes;
  if (path == "own") {
    for (std::uint32_t number = 0; number <= std::numeric_limits<std::uint16_t>::max(); ++number)
      classes.emplace_hint(classes.end(), static_cast<std::uint16_t>(number), static_cast<std::uint16_t>(number));
    return classes;
  }
  io::InputFile file(path, "rows of a class and its label");
  while (const std::optional<std::string_view> line = file.take_line()) {
    std::vector<std::string_view> words;
    for (std::string_view rest = line->substr(0, line->find('#')); !rest.empty();) {
      const std::size_t begin = rest.find_first_not_of(" \t\r,:");
      if (begin == rest.npos) break;
      const std::size_t end = std::min(rest.find_first_of(" \t\r,:", begin), rest.size());
      words.push_back(rest.substr(begin, end - begin));
      rest.remove_prefix(end);
    }
    if (words.empty()) continue;
    const auto number = [&](std::size_t k) { return text::number_in<std::uint16_t>(std::string(words[k])); };
    if (words.size() != 2 || !number(0) || !number(1))
      file.fail_at_line("has ", text::quoted(*line), ": expected a class and its label, from 0 to 65535");
    classes[*number(0)] = *number(1);
  }
  return classes;
}
