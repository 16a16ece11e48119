// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_ARCHIVE_HPP
#define PULSECAST_IO_DETAIL_ARCHIVE_HPP

#include <functional>
#include <map>
#include <typeinfo>
#include <variant>

#include <pulsecast/concepts.hpp>
#include <pulsecast/material/image.hpp>

/// Serialization for one program on one machine: arrays keep their layout, used in place.
namespace PULSECAST_NAMESPACE::io {

/// Archive of other types, or inconsistent.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace detail {

/// Archetype of archives: callable with the members of an object.
struct ArchiveArchetype {
  void operator()(auto&...) {}
};

/// Type that passes its members to an archive.
template <class T>
concept Archivable = requires(T& object, ArchiveArchetype& archive) {
  object.archive(archive);
};

/// Type that is made empty, and then filled by an archive.
template <class T>
concept Restorable = std::constructible_from<T, DeserializeTag> && Archivable<T>;

/// Type with an external list of members: `list_members(archive, object)`, in this namespace.
template <class T, class Archive>
concept ExternallyArchivable = requires(T& object, Archive& archive) {
  list_members(archive, object);
};

/// Plain value, defined by its bytes. Pointers inside a struct cannot be detected.
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !Archivable<T>;

/// Alignment of arrays used in place [byte]: the strictest that an element may have.
inline constexpr std::size_t array_alignment = 64;
inline constexpr std::size_t item_alignment = 8;  ///< alignment of everything else [byte]

[[nodiscard]] constexpr std::uint64_t aligned(std::uint64_t position, std::uint64_t to) noexcept {
  return (position + to - 1) / to * to;
}

/// Header of each run of elements, to check its type when read.
struct ItemHead {
  std::uint64_t type;   ///< hash of the types of the item and its elements
  std::uint64_t count;  ///< number of elements
};

template <class Item, class Element>
[[nodiscard]] std::uint64_t type_mark() {
  constexpr std::uint64_t layout = std::uint64_t{sizeof(Element)} << 8 | alignof(Element);
  return (typeid(Item).hash_code() * 31 + typeid(Element).hash_code()) * 31 + layout;
}

inline constexpr std::uint64_t shares_nothing = ~std::uint64_t{0};  ///< for an empty shared pointer

}  // namespace detail

void list_members(auto& a, Image& image) {
  auto& [width, height, channels, samples] = image;
  a(width, height, channels, samples);
}

/// Writes objects in sequence by a function of bytes, to a position that is a multiple of 64 bytes:
/// plain values, `SharedArray` arrays, strings, vectors, variants, shared pointers (shared objects
/// are written once), and types with `void archive(auto& a) { a(member1_, member2_, ...); }`.
class ArchiveWriter {
 public:
  using Write = std::function<void(std::span<const std::byte> bytes)>;

  explicit ArchiveWriter(Write write) : write_(std::move(write)) {}

  void operator()(const auto&... items) { (put(items), ...); }

 private:
  template <class Item, class Element>
  void put_elements(std::span<const Element> elements, std::size_t alignment = detail::item_alignment) {
    const detail::ItemHead head{detail::type_mark<Item, Element>(), elements.size()};
    put_bytes(std::as_bytes(std::span(&head, 1)), detail::item_alignment);
    if (!elements.empty()) put_bytes(std::as_bytes(elements), alignment);
  }

  void put_bytes(std::span<const std::byte> bytes, std::size_t alignment) {
    static constexpr std::array<std::byte, detail::array_alignment> zeros{};
    const std::span<const std::byte> gap(zeros.data(), detail::aligned(position_, alignment) - position_);
    for (const std::span<const std::byte> next : {gap, bytes}) {
      write_(next);
      position_ += next.size();
    }
  }

  template <detail::Plain T>
  void put(const T& value) {
    put_elements<T, T>({&value, 1});
  }
  template <class T>
  void put(const SharedArray<T>& array) {
    static_assert(alignof(T) <= detail::array_alignment);
    put_elements<SharedArray<T>, T>({array.data(), array.size()}, detail::array_alignment);
  }
  void put(const std::string& text) { put_elements<std::string, char>(text); }
  template <class T>
  void put(const std::vector<T>& items) {
    if constexpr (detail::Plain<T>) {
      put_elements<std::vector<T>, T>(items);
    } else {
      put(std::uint64_t{items.size()});
      for (const T& item : items) put(item);
    }
  }
  template <class... Options>
  void put(const std::variant<Options...>& choice) {
    put(std::uint64_t{choice.index()});
    std::visit([this](const auto& chosen) { this->put(chosen); }, choice);
  }
  template <class T>
  void put(const std::shared_ptr<const T>& shared) {
    if (!shared) return put(detail::shares_nothing);
    const auto [known, is_new] = numbers_.try_emplace({shared.get(), detail::type_mark<T, T>()}, numbers_.size());
    put(known->second);
    if (is_new) put(*shared);
  }
  // `archive` serves reading, too, so that it is not const
  template <detail::Archivable T>
  void put(const T& object) {
    const_cast<T&>(object).archive(*this);
  }
  template <detail::ExternallyArchivable<ArchiveWriter> T>
  void put(const T& object) {
    list_members(*this, const_cast<T&>(object));
  }

  Write write_;
  std::uint64_t position_ = 0;
  /// Numbers of shared objects, by address and type.
  std::map<std::pair<const void*, std::uint64_t>, std::uint64_t> numbers_;
};

/// Reads objects in the order of writing. Input is untrusted: inconsistent bytes throw an
/// `ArchiveError`; memory is for data present only. Objects may check themselves by `void
/// validate() const`, and by `bool is_consistent() const`: all indices in the arrays are in bounds.
class ArchiveReader {
 public:
  /// `owner` keeps the bytes alive, at a multiple of 64.
  ArchiveReader(std::span<const std::byte> bytes, std::shared_ptr<const void> owner)
      : bytes_(bytes), owner_(std::move(owner)) {}

  void operator()(auto&... items) { (take(items), ...); }

  /// Throws an `ArchiveError` unless all bytes were read; to be called last.
  void require_end() const { require(position_ == bytes_.size()); }

 private:
  static void require(bool fulfilled) {
    if (!fulfilled) throw ArchiveError("its members are inconsistent");
  }

  template <class Item, class Element>
  [[nodiscard]] std::span<const std::byte> take_elements(std::size_t alignment = detail::item_alignment) {
    detail::ItemHead head;
    std::memcpy(&head, take_bytes(1, sizeof head, detail::item_alignment).data(), sizeof head);
    require(head.type == (detail::type_mark<Item, Element>()));
    if (head.count == 0) return {};
    return take_bytes(head.count, sizeof(Element), alignment);
  }

  [[nodiscard]] std::span<const std::byte> take_bytes(std::uint64_t count, std::size_t each, std::size_t alignment) {
    const std::uint64_t begin = detail::aligned(position_, alignment);
    require(begin <= bytes_.size() && count <= (bytes_.size() - begin) / each);
    position_ = begin + count * each;
    return bytes_.subspan(begin, count * each);
  }

  template <detail::Plain T>
  void take(T& value) {
    const auto bytes = take_elements<T, T>();
    require(bytes.size() == sizeof value);
    if constexpr (std::same_as<T, bool>) require(bytes[0] <= std::byte{1});
    std::memcpy(&value, bytes.data(), sizeof value);
  }
  template <class T>
  void take(SharedArray<T>& array) {
    const auto bytes = take_elements<SharedArray<T>, T>(detail::array_alignment);
    array = SharedArray<T>({reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)}, owner_);
  }
  void take(std::string& text) {
    const auto bytes = take_elements<std::string, char>();
    text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  template <class T>
  void take(std::vector<T>& items) {
    if constexpr (detail::Plain<T>) {
      const auto bytes = take_elements<std::vector<T>, T>();
      items.resize(bytes.size() / sizeof(T));
      if (!bytes.empty()) std::memcpy(items.data(), bytes.data(), bytes.size());
    } else {
      std::uint64_t count = 0;
      take(count);
      for (items.clear(); count > 0; --count) take(items.emplace_back());  // bytes bound the count
    }
  }
  template <class... Options>
  void take(std::variant<Options...>& choice) {
    std::uint64_t index = 0;
    take(index);
    require(index < sizeof...(Options));
    take_option(choice, index, std::index_sequence_for<Options...>{});
  }
  template <std::size_t... I>
  void take_option(auto& choice, std::uint64_t index, std::index_sequence<I...>) {
    ((index == I ? take(choice.template emplace<I>()) : void()), ...);
  }
  template <class T>
  void take(std::shared_ptr<const T>& shared) {
    std::uint64_t number = 0;
    take(number);
    shared.reset();
    if (number == detail::shares_nothing) return;
    require(number <= shared_.size());
    if (number == shared_.size()) {
      shared_.push_back({nullptr, detail::type_mark<T, T>()});
      const auto object = made<T>();
      take(*object);
      shared_[number].object = object;
    }
    require(shared_[number].object && (shared_[number].type == detail::type_mark<T, T>()));
    shared = std::static_pointer_cast<const T>(shared_[number].object);
  }
  template <detail::Archivable T>
  void take(T& object) {
    object.archive(*this);
    check(object);
  }
  template <detail::ExternallyArchivable<ArchiveReader> T>
  void take(T& object) {
    list_members(*this, object);
    check(object);
  }

  template <class T>
  [[nodiscard]] static std::shared_ptr<T> made() {
    if constexpr (detail::Restorable<T>) {
      return std::make_shared<T>(DeserializeTag{});
    } else {
      return std::make_shared<T>();
    }
  }

  template <class T>
  static void check(const T& object) {
    static_assert(pulsecast::detail::members_checked<T, tag::SelfChecking, tag::Validated>);
    if constexpr (SelfChecking<T>) require(object.is_consistent());
    if constexpr (Validated<T>) object.validate();
  }

  struct Shared {
    std::shared_ptr<const void> object;  ///< null while it is being filled
    std::uint64_t type;
  };

  std::span<const std::byte> bytes_;
  std::shared_ptr<const void> owner_;
  std::uint64_t position_ = 0;
  std::vector<Shared> shared_;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
