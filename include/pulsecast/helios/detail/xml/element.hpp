// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_ELEMENT_HPP
#define PULSECAST_HELIOS_DETAIL_XML_ELEMENT_HPP

#include <pulsecast/base/suggestion.hpp>
#include <pulsecast/helios/detail/asset_search.hpp>
#include <pulsecast/helios/detail/settings/fields.hpp>
#include <pulsecast/helios/detail/xml/document.hpp>

/// Reading of elements. A missing attribute keeps its value, so that inheritance is reading twice.
namespace PULSECAST_NAMESPACE::helios {

/// Reads an element; `params` of a filter (`<param key value>`) as attributes. `finish` reports names not requested.
class XmlInput final : public FieldIo {
 public:
  using Read = std::function<void(XmlInput&)>;
  XmlInput(const XmlDocument& document, pugi::xml_node node, XmlReport& report, const AssetSearch& search,
           bool params = false)
      : document_(document), node_(node), report_(report), search_(search), params_(params) {
    if (params) known_children_ = {"param"};
  }
  [[nodiscard]] bool reads() const noexcept override { return true; }
  [[nodiscard]] pugi::xml_node node() const noexcept { return node_; }
  [[nodiscard]] const XmlDocument& document() const noexcept { return document_; }
  [[nodiscard]] XmlReport& report() const noexcept { return report_; }
  [[nodiscard]] const AssetSearch& search() const noexcept { return search_; }
  /// Position of an attribute; that of the element for none.
  [[nodiscard]] XmlPlace place(std::string_view name = {}) const {
    if (!params_ || name.empty()) return document_.place(node_, name);
    const pugi::xml_node given = param(name);
    return given ? document_.place(given, "value") : place();
  }

  void fault(std::string_view name, std::string problem) const override {
    report_.fault(place(name), std::move(problem));
  }
  void warn(std::string_view name, const std::string& problem) const override { report_.warn(place(name), problem); }
  /// Warns at another node, or at its attribute.
  void warn_at(pugi::xml_node node, std::string_view attribute, const std::string& problem) const {
    report_.warn(document_.place(node, attribute), problem);
  }

  [[nodiscard]] bool has(const char* name) const override {
    return params_ ? !param(name).empty() : !node_.attribute(name).empty();
  }
  [[nodiscard]] bool knows(std::string_view name) const override { return is_among(known_, name); }

  /// Reports missing attributes that are mandatory.
  void require(std::initializer_list<const char*> names) override {
    for (const char* name : names) {
      required_.emplace_back(name);
      if (!has(name)) fault("", tag(node_) + " has no " + (params_ ? "param " : "attribute ") + text::quoted(name));
    }
  }

  /// Text of an attribute, if it is given.
  [[nodiscard]] std::optional<std::string> given(const char* name) {
    if (!knows(name)) known_.emplace_back(name);
    if (!has(name)) return std::nullopt;
    return params_ ? param(name).attribute("value").value() : node_.attribute(name).value();
  }

  /// Text of an attribute; none if it is empty.
  [[nodiscard]] std::optional<std::string> value(const char* name) {
    auto text = given(name);
    if (!text || text->find_first_not_of(" \t\r\n") != text->npos) return text;
    const std::string problem = said(name, *text) + " is empty: ";
    is_among(required_, name) ? fault(name, problem + "expected a value") : warn(name, problem + "it is ignored");
    return std::nullopt;
  }

  using FieldIo::number, FieldIo::vector;
  void number(const char* name, double& v, const XmlUnit& unit, double low, double high) override {
    const auto text = value(name);
    if (!text) return;
    const auto found = number_of(*text);
    if (found && *found >= low && *found <= high) {
      v = unit.si(*found);
      ask_for_degrees(*this, name, v, unit);
      return;
    }
    std::string allowed = low == -any ? "" : " from " + xml_number(low);
    if (high < std::numeric_limits<double>::max()) allowed += " to " + xml_number(high);
    fault(name, said(name, *text) + ": expected a number" + allowed + (*unit.symbol == 0 ? "" : " ") + unit.symbol);
  }

  void whole(const char* name, int& number, int low, int high) override {
    const auto text = value(name);
    const auto found = text ? number_of(*text) : std::nullopt;
    if (found && *found == std::floor(*found) && *found >= low && *found <= high)
      number = static_cast<int>(*found);
    else if (text)
      fault(name, text::joined({said(name, *text), ": expected a whole number from ", std::to_string(low), " to ",
                                std::to_string(high)}));
  }

  void flag(const char* name, bool& flag) override {
    static constexpr std::array<std::string_view, 8> words{"true", "false", "1", "0", "yes", "no", "on", "off"};
    const std::string text = given(name).value_or("");
    const auto same = [&](std::string_view word) { return text::is_same_word(word, text); };
    std::size_t index = static_cast<std::size_t>(std::ranges::find_if(words, same) - words.begin());
    if (index == words.size()) return word(name, index, std::span(words).first(4), &flag);
    flag = index % 2 == 0;
    if (index >= 4)
      warn(name, said(name, text) + " is taken as " + (flag ? "true" : "false") + ": expected true or false");
  }

  void text(const char* name, std::string& value) override {
    if (auto text = given(name)) value = *std::move(text);
  }
  void text(const char* name, std::optional<std::string>& value) override {
    if (auto text = given(name)) value = std::move(text);
  }

  /// Case is ignored.
  void word(const char* name, std::size_t& index, std::span<const std::string_view> words,
            const void* /*member*/) override {
    const auto text = value(name);
    if (!text) return;
    for (std::size_t i = 0; i < words.size(); ++i)
      if (text::is_same_word(words[i], *text)) return void(index = i);
    const std::vector<std::string> known(words.begin(), words.end());
    fault(name, said(name, *text) + " is not known" + text::suggestion(*text, known));
  }

  /// The numbers are separated by semicolons.
  void vector(const char* name, Vec3& vector, double size_max) override {
    const auto text = value(name);
    if (!text) return;
    for (const char separator : {';', ',', ' '}) {
      const auto found = vector_of(*text, separator, size_max);
      if (!found) continue;
      if (separator != ';') warn(name, said(name, *text) + ": expected semicolons between the numbers, as in 'x;y;z'");
      vector = *found;
      return;
    }
    fault(name, said(name, *text) + ": expected three numbers 'x;y;z' of at most " + xml_number(size_max));
  }

  /// The file must exist.
  void file(const char* name, std::filesystem::path& path) override {
    if (const auto text = value(name)) {
      const AssetMatch match = search_.find(*text);
      take(name, *text, match);
      if (!match.files.empty()) path = match.files.front();
    }
  }

  /// Reports faults and warnings of a file search.
  void take(const char* name, std::string_view text, const AssetMatch& match) const {
    if (!match.problem.empty()) fault(name, said(name, text) + " " + match.problem);
    if (!match.warning.empty()) warn(name, said(name, text) + " " + match.warning);
  }

  /// Reads an optional child element. Returns true if it exists.
  bool child(const char* name, const Read& read) {
    known_children_.emplace_back(name);
    const pugi::xml_node found = node_.child(name);
    if (!found) return false;
    if (const pugi::xml_node second = found.next_sibling(name))
      warn_at(second, "", "a second " + tag(second) + " in " + tag(node_) + ": the first one is used");
    inside(found, read);
    return true;
  }
  bool element(const char* name, const Fields& fields) override { return child(name, fields); }
  void each(const char* name, std::size_t i, const EachFields& fields) override {
    known_children_.emplace_back(name);
    for (const pugi::xml_node node : node_.children(name)) inside(node, [&](XmlInput& inner) { fields(inner, i++); });
  }
  /// Reads another element of the document.
  void inside(pugi::xml_node node, const Read& read) const {
    XmlInput inner(document_, node, report_, search_);
    read(inner);
    inner.finish();
  }

  /// Warns of attributes that are allowed, but have no effect.
  void without_effect(std::initializer_list<const char*> names, const char* why = "has no effect") override {
    for (const char* name : names)
      if (given(name)) warn(name, (params_ ? "param " : "attribute ") + text::quoted(name) + " " + why);
  }

  /// Adds known names that are not requested.
  void know(std::initializer_list<const char*> attributes, std::initializer_list<const char*> children = {}) {
    known_.insert(known_.end(), attributes.begin(), attributes.end());
    known_children_.insert(known_children_.end(), children.begin(), children.end());
  }

  /// Reports attributes and children that were not requested.
  void finish() const {
    static const std::vector<std::string> of_filter{"type"};
    check_attributes(node_, params_ ? of_filter : known_);
    for (const pugi::xml_node child : node_.children()) {
      if (report_.is_full_of_warnings()) return;
      if (child.type() == pugi::node_element && !is_among(known_children_, child.name()))
        warn_at(child, "",
                "element " + tag(child) + " in " + tag(node_) + " is not known" +
                    text::suggestion(child.name(), known_children_));
    }
    check_texts(node_, takes_text_ ? node_.text().data() : pugi::xml_node());
    if (params_) check_params();
  }

  /// Reports attributes of a node that are not known.
  void check_attributes(pugi::xml_node node, const std::vector<std::string>& known) const {
    for (const pugi::xml_attribute attribute : node.attributes()) {
      const std::string_view name = attribute.name();
      if (name.starts_with("xmlns") || name.starts_with("xsi:") || name.starts_with("xml:") || is_among(known, name))
        continue;
      warn_at(node, name,
              "attribute " + text::quoted(name) + " of " + tag(node) + " is not known" + text::suggestion(name, known));
    }
  }

  /// Text between the tags.
  [[nodiscard]] std::string content() {
    takes_text_ = true;
    return node_.text().get();
  }

  [[nodiscard]] pugi::xml_node param(std::string_view key) const {
    for (const pugi::xml_node node : node_.children("param"))
      if (node.attribute("key").value() == key) return node;
    return {};
  }

  /// `<name>`, for messages.
  [[nodiscard]] static std::string tag(pugi::xml_node node) {
    return text::joined({"<", std::string_view(node.name()).substr(0, 80), ">"});
  }

 private:
  static constexpr std::size_t max_params = 100;

  [[nodiscard]] static bool is_among(const std::vector<std::string>& known, std::string_view name) {
    return std::ranges::find(known, name) != known.end();
  }

  /// Reports texts in a node, but for one that is read.
  void check_texts(pugi::xml_node node, pugi::xml_node read = {}) const {
    for (const pugi::xml_node inner : node.children())
      if (inner != read && (inner.type() == pugi::node_pcdata || inner.type() == pugi::node_cdata))
        warn_at(node, "", tag(node) + " holds the text " + text::quoted(inner.value()) + ": it has no effect");
  }

  void check_params() const {
    std::vector<std::string_view> keys;
    for (const pugi::xml_node child : node_.children("param")) {
      if (report_.is_full() || report_.is_full_of_warnings() || keys.size() == max_params) return;
      check_param(child);
      const std::string_view key = child.attribute("key").value();
      const std::string name = "param " + text::quoted(key);
      if (std::ranges::find(keys, key) != keys.end()) {
        const std::string_view first = param(key).attribute("value").value();
        if (first == child.attribute("value").value())
          warn_at(child, "key", name + " is given twice");
        else
          report_.fault(document_.place(child, "key"), name + " is given twice, with another value");
      }
      keys.push_back(key);
      if (keys.size() == max_params) fault("", "too many <param> in a filter");
      if (!is_among(known_, key))
        warn_at(child, "key",
                name + " of filter " + text::quoted(node_.attribute("type").value()) + " is not known" +
                    text::suggestion(key, known_));
    }
  }

  void check_param(pugi::xml_node child) const {
    static const std::vector<std::string> names{"type", "key", "value", "rotations"};
    static const std::vector<std::string> types{"string",  "boolean", "bool", "double",
                                                "integer", "int",     "vec3", "rotation"};
    check_attributes(child, names);
    check_texts(child);
    const std::string_view type = child.attribute("type").value();
    if (!type.empty() && !is_among(types, type))
      warn_at(child, "type", said("type", type) + " is not known" + text::suggestion(type, types));
    if (type == "rotation") return;
    if (!child.attribute("value")) warn_at(child, "", "<param> has no attribute 'value'");
    for (const pugi::xml_node inner : child.children())
      if (inner.type() == pugi::node_element)
        warn_at(inner, "", "element " + tag(inner) + " in <param>: expected it in one of type rotation");
  }

  const XmlDocument& document_;
  pugi::xml_node node_;
  XmlReport& report_;
  const AssetSearch& search_;
  std::vector<std::string> known_{}, known_children_{}, required_{};
  bool params_, takes_text_ = false;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
