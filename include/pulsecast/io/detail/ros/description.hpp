// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_ROS_DESCRIPTION_HPP
#define PULSECAST_IO_DETAIL_ROS_DESCRIPTION_HPP

#include <algorithm>
#include <span>
#include <tuple>
#include <vector>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <pulsecast/base/require.hpp>

/// Descriptions of message types, from which come their definitions and the encoding of messages.
namespace PULSECAST_NAMESPACE::io::ros {

/// Description of a message type: its name, as "std_msgs/msg/Header", and its fields, which are members, in order.
#define PULSECAST_ROS_MESSAGE(type, ...)                  \
  static constexpr const char* ros_type = type;           \
  static constexpr const char* ros_fields = #__VA_ARGS__; \
  [[nodiscard]] constexpr auto ros_values() const noexcept { return std::tie(__VA_ARGS__); }

/// Struct with a `PULSECAST_ROS_MESSAGE`. Fields are numbers, texts as `std::string_view`, other messages,
/// `std::array`s, and sequences with `size` and `[]`; bytes may be `std::byte`.
template <class M>
concept RosMessage = std::same_as<decltype(M::ros_fields), const char* const>;

namespace detail {

template <class T>
inline constexpr bool is_number = std::is_arithmetic_v<T> || std::is_same_v<T, std::byte>;
template <class T>
inline constexpr bool is_text = std::is_same_v<T, std::string_view>;
template <class T>
inline constexpr std::size_t array_length = 0;  // of no array
template <class T, std::size_t length>
inline constexpr std::size_t array_length<std::array<T, length>> = length;
template <class Sequence>
using Element = std::remove_cv_t<typename Sequence::value_type>;

/// Definition of a message type and its parts under construction, with a zero at its end.
struct DefinitionText {
  std::array<char, 2048> characters{};
  std::size_t size = 0;

  constexpr DefinitionText& add(std::string_view part) {
    for (const char c : part) characters[size++] = c;
    return *this;
  }

  /// Adds the name of a message type as definitions have it, as "std_msgs/Header".
  constexpr DefinitionText& add_name(std::string_view type) {
    return add(type.substr(0, type.find('/'))).add(type.substr(type.rfind('/')));
  }

  /// Adds the fields of a message type, a line each, and the message types in them that are not yet there.
  template <RosMessage M>
  constexpr void add_fields() {
    std::string_view names = M::ros_fields;
    const auto each = [&]<class... T>(const std::tuple<const T&...>*, const auto& use) {
      (use(static_cast<const T*>(nullptr)), ...);
    };
    constexpr decltype(std::declval<const M&>().ros_values())* types = nullptr;
    each(types, [&]<class T>(const T*) {
      add_type<T>();
      const std::size_t end = std::min(names.find(','), names.size());
      add(" ").add(names.substr(0, end)).add("\n");
      names.remove_prefix(std::min(names.find_first_not_of(", ", end), names.size()));
    });
    each(types, [&]<class T>(const T*) { add_part<T>(); });
  }

 private:
  template <class T>
  constexpr void add_type() {
    if constexpr (std::is_same_v<T, bool>) {
      add("bool");
    } else if constexpr (is_number<T>) {
      add(std::is_floating_point_v<T> ? "float" : std::is_signed_v<T> ? "int" : "uint");
      add(sizeof(T) == 1 ? "8" : sizeof(T) == 2 ? "16" : sizeof(T) == 4 ? "32" : "64");
    } else if constexpr (is_text<T>) {
      add("string");
    } else if constexpr (RosMessage<T>) {
      add_name(T::ros_type);
    } else {
      add_type<Element<T>>();
      constexpr std::size_t length = array_length<T>;
      add("[").add({&"0123456789"[length / 10 % 10], length >= 10});
      add({&"0123456789"[length % 10], length > 0}).add("]");
    }
  }

  template <class T>
  constexpr void add_part() {
    if constexpr (RosMessage<T>) {
      DefinitionText head;
      for (int i = 0; i < 80; ++i) head.add("=");
      head.add("\nMSG: ").add_name(T::ros_type).add("\n");
      const std::string_view title(head.characters.data(), head.size);
      if (std::string_view(characters.data(), size).find(title) == title.npos) add(title).template add_fields<T>();
    } else if constexpr (!is_number<T> && !is_text<T>) {
      add_part<Element<T>>();
    }
  }
};

template <RosMessage M>
inline constexpr DefinitionText definition_text = [] {
  DefinitionText text;
  text.add_fields<M>();
  return text;
}();

/// Length of an encoded value with the padding around it, at most [byte].
template <class T>
[[nodiscard]] std::size_t max_size(const T& value) noexcept {
  if constexpr (is_number<T>) {
    return 2 * sizeof(T);
  } else if constexpr (RosMessage<T>) {
    return std::apply([](const auto&... field) { return (max_size(field) + ...); }, value.ros_values());
  } else {
    std::size_t size = 2 * sizeof(std::uint32_t) + 1;  // length, and the zero of a text
    if constexpr (is_number<Element<T>>) return size + (value.size() + 1) * sizeof(Element<T>);
    for (std::size_t i = 0; i < value.size(); ++i) size += max_size(value[i]);
    return size;
  }
}

template <class T>
void encode(eprosima::fastcdr::Cdr& cdr, const T& value) {
  if constexpr (is_number<T>) {
    cdr << value;
  } else if constexpr (RosMessage<T>) {
    std::apply([&](const auto&... field) { (encode(cdr, field), ...); }, value.ros_values());
  } else {
    if constexpr (array_length<T> == 0) cdr << static_cast<std::uint32_t>(value.size() + is_text<T>);
    if constexpr (std::is_same_v<Element<T>, std::byte>) {
      cdr.serializeArray(reinterpret_cast<const std::uint8_t*>(value.data()), value.size());
    } else if constexpr (is_number<Element<T>>) {
      cdr.serializeArray(value.data(), value.size());
    } else {
      for (std::size_t i = 0; i < value.size(); ++i) encode(cdr, value[i]);
    }
    if constexpr (is_text<T>) cdr << '\0';
  }
}

}  // namespace detail

/// Name of a message type, as "std_msgs/msg/Header".
template <RosMessage M>
inline constexpr const char* type_of = M::ros_type;

/// Definition of a message type and its parts, in the encoding "ros2msg". Source: MCAP format registry, ros2msg.
template <RosMessage M>
inline constexpr const char* definition_of = detail::definition_text<M>.characters.data();

/// Writes a message in little-endian CDR after an encapsulation header, as ROS 2 sends and records it, into `bytes`,
/// and allocates nothing but these. @throws SettingError for more than 2^32 - 1 bytes
/// Source: OMG DDSI-RTPS 2.5, 10, CDR_LE.
template <RosMessage M>
void serialize(const M& message, std::vector<std::byte>& bytes) {
  constexpr std::array<std::byte, 4> encapsulation{std::byte{0}, std::byte{1}};
  const std::size_t room = detail::max_size(message);
  require_within(type_of<M>, static_cast<double>(room), 0, 0xFFFFFFFF, "byte");
  bytes.assign(encapsulation.size() + room, std::byte{});  // the padding of numbers is zero
  std::ranges::copy(encapsulation, bytes.begin());
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(bytes.data() + encapsulation.size()), room);
  eprosima::fastcdr::Cdr cdr(buffer);
  detail::encode(cdr, message);
  bytes.resize(encapsulation.size() + cdr.getSerializedDataLength());
}

}  // namespace PULSECAST_NAMESPACE::io::ros

#endif
