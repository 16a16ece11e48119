// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/archive.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/input_file.hpp>
#include <pulsecast/io/output_file.hpp>

#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using namespace pulsecast::support;

namespace {

const TemporaryFolder folder;

struct alignas(64) Wide {
  double x[8] = {};
};

/// An object that shows its members, and checks itself.
class Leaf {
 public:
  explicit Leaf(std::vector<std::uint16_t> numbers) : numbers_(std::move(numbers)), wide_(std::vector<Wide>(2)) {}
  explicit Leaf(DeserializeTag) {}
  template <class Archive>
  void archive(Archive& a) {
    a(numbers_, wide_, even_);
  }
  [[nodiscard]] bool is_consistent() const { return numbers_.size() == 3; }
  [[nodiscard]] const SharedArray<std::uint16_t>& numbers() const { return numbers_; }
  [[nodiscard]] const SharedArray<Wide>& wide() const { return wide_; }

 private:
  SharedArray<std::uint16_t> numbers_;
  SharedArray<Wide> wide_;
  bool even_ = true;
};

struct Tree {
  std::string name;
  std::vector<std::string> words;
  std::vector<int> numbers;
  std::variant<std::shared_ptr<const Leaf>, std::shared_ptr<const std::vector<double>>> fruit;
  std::shared_ptr<const Leaf> leaf;

  template <class Archive>
  void archive(Archive& a) {
    a(name, words, numbers, fruit, leaf);
  }
};

/// The file that the items make.
template <class... Items>
std::shared_ptr<const MappedFile> archived(const Items&... items) {
  OutputFile file(folder / "archive");
  ArchiveWriter writer([&](std::span<const std::byte> bytes) { file.write(bytes); });
  writer(items...);
  file.commit();
  return std::make_shared<const MappedFile>(folder / "archive");
}

template <class... Items>
void take(const std::shared_ptr<const MappedFile>& file, Items&... items) {
  ArchiveReader reader(file->bytes(), file);
  reader(items...);
  reader.require_end();
}

}  // namespace

TEST_CASE("every kind of item comes back, and arrays stand where the file is") {
  const auto leaf = std::make_shared<const Leaf>(std::vector<std::uint16_t>{1, 2, 3});
  const Tree tree{"oak", {"", "two"}, {7, 8, 9}, leaf, leaf};
  const auto file = archived(tree, 3.5, true, std::array<char, 3>{'a', 'b', 'c'}, std::string(), SharedArray<float>());
  Tree again;
  double number = 0;
  bool truth = false;
  std::array<char, 3> letters{};
  std::string nothing = "something";
  SharedArray<float> empty(std::vector<float>{1});
  take(file, again, number, truth, letters, nothing, empty);
  CHECK(again.name == "oak");
  CHECK(again.words == tree.words);
  CHECK(again.numbers == tree.numbers);
  CHECK(number == 3.5);
  CHECK(truth);
  CHECK(letters == std::array<char, 3>{'a', 'b', 'c'});
  CHECK(nothing.empty());
  CHECK(empty.empty());
  REQUIRE(again.leaf);
  CHECK(again.leaf == std::get<0>(again.fruit));
  const SharedArray<std::uint16_t>& numbers = again.leaf->numbers();
  CHECK(std::vector<std::uint16_t>(numbers.begin(), numbers.end()) == std::vector<std::uint16_t>{1, 2, 3});
  const auto* const place = reinterpret_cast<const std::byte*>(numbers.data());
  CHECK((place >= file->bytes().data() && place < file->bytes().data() + file->bytes().size()));
  CHECK(reinterpret_cast<std::uintptr_t>(again.leaf->wide().data()) % alignof(Wide) == 0);
}

TEST_CASE("an array keeps the file in memory") {
  SharedArray<int> array;
  {
    const auto file = archived(SharedArray<int>(std::vector<int>{1, 2, 3}));
    take(file, array);
  }
  std::filesystem::remove(folder / "archive");
  CHECK(array[2] == 3);
}

TEST_CASE("what is shared is put once, and nothing where there is nothing") {
  const auto one = std::make_shared<const std::vector<double>>(1000, 1.5),
             other = std::make_shared<const std::vector<double>>(*one);
  const std::vector<std::shared_ptr<const std::vector<double>>> all{one, other, nullptr, one, one};
  const auto file = archived(all);
  CHECK(file->bytes().size() < 2 * 8000 + 1000);
  auto again = all;
  take(file, again);
  REQUIRE(again.size() == 5);
  CHECK(*again[0] == *one);
  CHECK(again[0] == again[3]);
  CHECK(again[0] == again[4]);
  CHECK(again[0] != again[1]);
  CHECK(again[2] == nullptr);
}

TEST_CASE("an item is taken as what it was put, or not at all") {
  const auto file = archived(1.5F);
  double wider = 0;
  std::int32_t other = 0;
  SharedArray<float> array;
  std::vector<float> list;
  float right = 0;
  CHECK_THROWS_AS(take(file, wider), ArchiveError);
  CHECK_THROWS_AS(take(file, other), ArchiveError);
  CHECK_THROWS_AS(take(file, array), ArchiveError);
  CHECK_THROWS_AS(take(file, list), ArchiveError);
  CHECK_THROWS_AS(take(file, right, right), ArchiveError);
  CHECK_NOTHROW(take(file, right));
  ArchiveReader reader(file->bytes(), file);
  CHECK_THROWS_AS(reader.require_end(), ArchiveError);
}

TEST_CASE("an object that is not sound is refused") {
  const auto file = archived(std::make_shared<const Leaf>(std::vector<std::uint16_t>{1, 2}));
  std::shared_ptr<const Leaf> leaf;
  CHECK_THROWS_AS(take(file, leaf), ArchiveError);
}

TEST_CASE("a choice that is not offered, a truth that is neither, and something shared of another type are refused") {
  const auto forged = [](std::shared_ptr<const MappedFile> file, std::size_t at, std::byte value) {
    std::vector<std::byte> bytes(file->bytes().begin(), file->bytes().end());
    bytes.at(at) = value;
    return bytes;
  };
  std::variant<int, float> choice = 2.5F;
  const std::vector<std::byte> third = forged(archived(choice), 16, std::byte{2});  // behind the head of its number
  CHECK_THROWS_AS(ArchiveReader(third, nullptr)(choice), ArchiveError);
  bool truth = true;
  const std::vector<std::byte> neither = forged(archived(truth), 16, std::byte{2});
  CHECK_THROWS_AS(ArchiveReader(neither, nullptr)(truth), ArchiveError);

  std::shared_ptr<const std::vector<double>> numbers = std::make_shared<const std::vector<double>>();
  std::shared_ptr<const std::vector<float>> others = std::make_shared<const std::vector<float>>();
  const auto file = archived(numbers, others);
  const std::vector<std::byte> crossed =
      forged(file, 24 + 16 + 16, std::byte{0});  // the number of the second, behind the first's
  REQUIRE(crossed[24 + 16] != std::byte{0xff});
  CHECK_NOTHROW(take(file, numbers, others));
  CHECK_THROWS_AS(ArchiveReader(crossed, nullptr)(numbers, others), ArchiveError);
  const std::vector<std::byte> ahead = forged(file, 16, std::byte{9});
  CHECK_THROWS_AS(ArchiveReader(ahead, nullptr)(numbers, others), ArchiveError);
}
