// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_LIBRARY_HPP
#define PULSECAST_HELIOS_DETAIL_XML_LIBRARY_HPP

#include <memory>
#include <unordered_map>

#include <pulsecast/helios/detail/xml/element.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Folders, and then that of a file.
[[nodiscard]] inline auto and_own(std::vector<std::filesystem::path> folders, const std::filesystem::path& file) {
  folders.push_back(std::filesystem::absolute(file).parent_path());
  return folders;
}

/// Document, its elements by id. Its files are searched in the folders of assets, of the survey, and its own.
class XmlLibraryDocument {
 public:
  XmlLibraryDocument(const std::filesystem::path& path, const std::vector<std::filesystem::path>& folders,
                     XmlReport& report)
      : document_(path), search_(and_own(folders, path)) {
    if (document_.oddity()) report.warn(document_.oddity()->place, document_.oddity()->problem);
    const pugi::xml_node root = document_.root();
    if (std::string_view(root.name()) != "document")
      report.fault(document_.place(root), "the root element is " + XmlInput::tag(root) + ": expected <document>");
    read(root, report, [](XmlInput& io) {
      io.know({}, {"platform", "scanner", "scene", "platformSettings", "scannerSettings", "survey"});
    });
    for (const pugi::xml_node node : root.children()) {
      if (node.type() != pugi::node_element || std::string_view(node.name()) == "survey") continue;
      const char* const id = node.attribute("id").value();
      if (!by_id_.emplace(key(node.name(), id), node).second)
        report.warn(document_.place(node),
                    "a second " + XmlInput::tag(node) + " with the id " + text::quoted(id) + ": the first one is used");
    }
  }

  void read(pugi::xml_node node, XmlReport& report, const XmlInput::Read& read) const {
    XmlInput(document_, node, report, search_).inside(node, read);
  }

  [[nodiscard]] const XmlDocument& document() const noexcept { return document_; }
  [[nodiscard]] const AssetSearch& search() const noexcept { return search_; }

  /// Element by name and id; empty if there is none.
  [[nodiscard]] pugi::xml_node find(std::string_view element, std::string_view id) const {
    const auto found = by_id_.find(key(element, id));
    return found == by_id_.end() ? pugi::xml_node() : found->second;
  }

  [[nodiscard]] std::vector<std::string> ids(const char* element) const {
    std::vector<std::string> all;
    for (const pugi::xml_node node : document_.root().children(element)) all.emplace_back(node.attribute("id").value());
    return all;
  }

 private:
  [[nodiscard]] static std::string key(std::string_view element, std::string_view id) {
    return text::joined({element, "#", id});
  }

  XmlDocument document_;
  AssetSearch search_;
  std::unordered_map<std::string, pugi::xml_node> by_id_;
};

/// Referenced element and its document; empty if it was not found, which is reported.
struct XmlReference {
  const XmlLibraryDocument* document = nullptr;
  pugi::xml_node node{};

  explicit operator bool() const noexcept { return document != nullptr; }
};

/// Documents that a survey refers to. Each is read once.
class XmlLibrary {
 public:
  static constexpr std::size_t max_documents = 256;

  XmlLibrary(std::vector<std::filesystem::path> folders, XmlReport& report)
      : folders_(std::move(folders)), report_(report) {}

  /// Document of a path; throws if it is unreadable. Reports unknown elements.
  const XmlLibraryDocument& read(const std::filesystem::path& path) {
    auto& document = documents_[path.string()];
    if (!document) document = std::make_unique<XmlLibraryDocument>(path, folders_, report_);
    return *document;
  }

  /// Resolves a reference: `file.xml#id`, or `id` or `#id` for an element of the same document.
  [[nodiscard]] XmlReference find(const XmlInput& io, const XmlLibraryDocument& from, const char* attribute,
                                  const std::string& text, const char* element) {
    const std::size_t sign = text.find('#');
    const std::string path = sign == text.npos ? "" : text.substr(0, sign);
    const std::string id = text.substr(sign + 1);  // all of it without the sign
    const XmlLibraryDocument* const document = path.empty() ? &from : other(io, from, attribute, text, path);
    if (document == nullptr) return {};
    if (const pugi::xml_node node = document->find(element, id); node && !id.empty()) return {document, node};
    const bool is_path = sign == text.npos && id.ends_with(".xml");
    io.fault(attribute,
             text::joined({said(attribute, text), ": there is no <", element, "> with the id ", text::quoted(id),
                           " in ", document->document().path(),
                           is_path ? "; expected file.xml#id" : text::suggestion(id, document->ids(element))}));
    return {};
  }

 private:
  const XmlLibraryDocument* other(const XmlInput& io, const XmlLibraryDocument& from, const char* attribute,
                                  const std::string& text, const std::string& path) {
    const AssetMatch match = from.search().find(path);
    io.take(attribute, text, match);
    if (match.files.empty()) return nullptr;
    std::string problem = " cannot be read";
    const auto known = documents_.find(match.files.front().string());
    if (known != documents_.end() && known->second) return known->second.get();
    if (known == documents_.end() && documents_.size() == max_documents) {
      problem = " exceeds the maximum of " + std::to_string(max_documents) + " documents";
    } else if (known == documents_.end()) {
      try {
        return &read(match.files.front());
      } catch (const XmlFaults& faults) {
        for (const XmlFault& fault : faults.faults()) report_.fault(fault.place, fault.problem);
      } catch (const FileError& error) {
        report_.fault({.path = error.path()}, error.problem());
      }
    }
    io.fault(attribute, said(attribute, text) + problem);
    return nullptr;
  }

  std::vector<std::filesystem::path> folders_;
  XmlReport& report_;
  std::unordered_map<std::string, std::unique_ptr<XmlLibraryDocument>> documents_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
