// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_KITTI_HPP
#define PULSECAST_IO_KITTI_HPP

#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/scan_splitter.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Classes of SemanticKITTI by those of echoes. Classes without an entry are 0, unlabeled, and
/// counted by `KittiWriter::unlabelled` but for 0 and 1, which LAS has for unclassified.
using KittiClasses = std::map<std::uint16_t, std::uint16_t>;

/// Table for the classes of LAS that have a counterpart; those from 64 on are the user's. Source:
/// ASPRS LAS 1.4 R15, table of classes; semantic-kitti-api, config/semantic-kitti.yaml.
[[nodiscard]] inline KittiClasses kitti_classes() {
  return {{2, 72},    // ground: terrain
          {3, 70},    // low vegetation: vegetation
          {4, 70},    // medium vegetation: vegetation
          {5, 70},    // high vegetation: vegetation
          {6, 50},    // building: building
          {7, 1},     // low point, noise: outlier
          {11, 40},   // road surface: road
          {15, 52},   // transmission tower: other-structure
          {18, 1},    // high noise: outlier
          {19, 52}};  // overhead structure: other-structure
}

namespace detail {

/// Adds a pose in the frame of the first one as a row: 3 by 4, by rows, axes x forward, y left, z up.
template <class From, class To>
void add_kitti_pose(TextOutput& poses, const Pose<From, To>& pose) {
  const auto column = [&](const Vec3& axis) { return to_forward_left_up(pose.rotation * from_forward_left_up(axis)); };
  const Vec3 x = column({1, 0, 0}), y = column({0, 1, 0}), z = column({0, 0, 1});
  const Vec3 at = to_forward_left_up(pose.position);
  for (int row = 0; row < 3; ++row) poses.reals(12, x[row], y[row], z[row], at[row]);
  poses.end_row();
}

}  // namespace detail

/// Writes poses of a body as the `poses.txt` of a sequence: in the frame of the first, at the times of the scans. For
/// TUM, `write_trajectory` has `tum_format()`. @throws FileError for poses that are not finite
inline void write_kitti_poses(const std::filesystem::path& path, std::span<const TimedPose> poses) {
  TextOutput file{OutputFile(path)};
  Pose<frame::World, frame::Body> first;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose<frame::Body, frame::World> pose{unit(poses[i].rotation), poses[i].position};
    if (!pose.finite() || !(length(poses[i].rotation) > 0))
      throw FileError(path.string(), text::message("pose ", i), "cannot be written: expected a finite pose");
    if (i == 0) first = pose.inverse();
    detail::add_kitti_pose(file, first * pose);
  }
  file.close();
}

/// Settings of a SemanticKITTI sequence.
struct KittiSettings {
  double scan_rate = 10;                   ///< scans per second [Hz]
  KittiClasses classes = kitti_classes();  ///< classes in the labels by those of the echoes
  PointSettings points{};                  ///< pose of the sensor (required), and distortion

  void validate() const {
    require_within("KittiSettings::scan_rate", scan_rate, 1e-3, 1e6, "Hz");
    points.validate();
    if (!points.sensor)
      throw SettingError("PointSettings::sensor (poses)", 0, "", "1, for points in the frame of a sensor");
  }
};

/// Writes scans as a sequence folder of SemanticKITTI. Source: Behley et al. 2019, SemanticKITTI;
/// semantic-kitti-api. Scans are those of `ScanSplitter`, numbered from 0:
/// - velodyne/000000.bin: floats x forward, y left, z up [m] of the sensor, reflectance up to 1;
/// - labels/000000.label: of each point 32 bits, object modulo 65536 in the upper 16, class below;
/// - times.txt: seconds since the first scan, one line a scan;
/// - poses.txt: sensor at each start in the frame of the first, axes as above: 3 by 4, by rows;
/// - calib.txt: the identity as Tr, from the sensor to the frame of the poses. No cameras.
///
/// Files of a scan are complete with the scan, others with `close()`. Throws a `FileError`.
class KittiWriter {
 public:
  /// Creates the folder. @throws SettingError for settings out of range @throws FileError
  KittiWriter(std::filesystem::path folder, const KittiSettings& settings)
      : folder_(std::move(folder)),
        classes_(settings.classes),
        splitter_(PointBuffer(layout(), in_format(validated(settings).points)), settings.scan_rate,
                  [this](const PointBuffer& scan) { write(scan); }),
        times_(OutputFile(new_folder() / "times.txt")),
        poses_(OutputFile(folder_ / "poses.txt")) {}
  KittiWriter(const KittiWriter&) = delete;
  KittiWriter& operator=(const KittiWriter&) = delete;

  void operator()(const EchoBatch& batch) { splitter_(batch); }

  /// Numbers of points of the classes without an entry, by class.
  [[nodiscard]] const std::map<std::uint16_t, std::uint64_t>& unlabelled() const noexcept { return unlabelled_; }

  /// Completes the last scan and the sequence. Throws a `FileError`.
  void close() {
    splitter_.close();
    OutputFile calibration(folder_ / "calib.txt");
    calibration.write(std::string_view("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n"));
    calibration.commit();
    poses_.close();
    times_.close();
  }

 private:
  [[nodiscard]] static PointLayout layout() {
    return PointLayout::packed(layouts::xyz_float())
        .with(layouts::columns({column("reflectance"), column("classification"), column("object")}));
  }

  [[nodiscard]] static PointSettings in_format(PointSettings points) {
    points.axes = PointAxes::forward_left_up;
    return points;
  }

  /// Creates the folders. Throws a `FileError` if there are scans of an earlier sequence.
  [[nodiscard]] const std::filesystem::path& new_folder() const {
    for (const std::string_view name : {"velodyne", "labels"}) {
      const std::filesystem::path folder = folder_ / name;
      std::error_code error;
      std::filesystem::create_directories(folder, error);
      const bool empty = !error && std::filesystem::is_empty(folder, error);
      if (error)
        throw FileError(folder.string(), "",
                        text::joined({"cannot be created: ", error.message(), "; expected a writable folder"}));
      if (!empty) throw FileError(folder.string(), "", "holds files already; expected a folder without scans");
    }
    return folder_;
  }

  void write(const PointBuffer& scan) {
    const std::string number = std::to_string(scans_++);
    const std::string name = std::string(6 - std::min<std::size_t>(6, number.size()), '0') + number;
    OutputFile points(folder_ / "velodyne" / (name + ".bin"));
    OutputFile labels(folder_ / "labels" / (name + ".label"));
    const std::vector<PointField>& fields = scan.layout().fields;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      std::array<float, 4> point;
      std::memcpy(point.data(), scan.records().data() + i * scan.layout().size, sizeof point);
      point[3] = point[3] > 0 ? std::min(point[3], 1.0F) : 0;
      points.write(std::as_bytes(std::span(point)));
      const auto of_echo = static_cast<std::uint16_t>(scan.number(i, fields[4]));
      const auto known = classes_.find(of_echo);
      if (known == classes_.end() && of_echo > 1) ++unlabelled_[of_echo];
      const auto instance = static_cast<std::uint32_t>(scan.number(i, fields[5]));
      const std::uint32_t label = instance << 16 | (known == classes_.end() ? 0 : known->second);
      labels.write(std::as_bytes(std::span(&label, 1)));
    }
    points.commit();
    labels.commit();
    const double start = scan.scan_start().seconds();
    if (!first_start_) first_start_ = start;
    times_.reals(9, start - *first_start_).end_row();
    write_pose(scan.settings().sensor(scan.scan_start()));
  }

  void write_pose(const Pose<frame::Instrument, frame::World>& sensor) {
    if (!first_) first_ = sensor.inverse();
    detail::add_kitti_pose(poses_, *first_ * sensor);
  }

  std::filesystem::path folder_;
  KittiClasses classes_;
  std::map<std::uint16_t, std::uint64_t> unlabelled_;
  ScanSplitter splitter_;
  TextOutput times_, poses_;
  std::size_t scans_ = 0;
  std::optional<double> first_start_;                           // start of the first scan [s]
  std::optional<Pose<frame::World, frame::Instrument>> first_;  // frame of the first scan
};
static_assert(EchoSink<KittiWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
