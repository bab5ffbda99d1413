// scenario_members SCHEMA CHOICES STRUCTS SOURCE: writes the choices and structs of
// scenarios/schema.json as two C++ headers, and their reading and writing as JSON as a source. The
// build runs it (scenarios/CMakeLists.txt).
//
// An object with "x-type" is a struct of this name, a word with it an enum, each member in the
// order of the schema, with its description above it. A member that may be left out has the
// schema's default, and is an std::optional where there is none. "x-name" is a member's name in
// C++, "x-declares" has what a struct declares beside its members (defined in
// scenarios/scenario.h), and "x-kinds" are the alternatives of a variant, each a struct with the
// members that it needs. Objects of one "x-type" must have the same members.
#include <cctype>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/schema_references.h"

namespace {

using nlohmann::ordered_json;

// "full_slave" is "FullSlave".
std::string camel_case(const std::string& words) {
  std::string result;
  bool begins = true;
  for (const char letter : words) {
    if (letter == '_') {
      begins = true;
      continue;
    }
    result += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(letter))) : letter;
    begins = false;
  }
  return result;
}

bool has_type(const ordered_json& node, const std::string& name) {
  if (!node.contains("type")) return false;
  const ordered_json& type = node["type"];
  if (!type.is_array()) return type == name;
  for (const ordered_json& each : type) {
    if (each == name) return true;
  }
  return false;
}

// The text as lines of a comment of at most 100 columns.
std::string comment(const std::string& text, const std::string& indent) {
  constexpr std::size_t kColumns = 100;
  std::string result;
  std::string line = indent + "//";
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > kColumns) {
      result += line + '\n';
      line = indent + "//";
    }
    line += ' ' + word;
  }
  return result + line + '\n';
}

// The type of a value that is there.
std::string value_type(const ordered_json& node) {
  if (node.contains("x-type")) return node["x-type"];
  if (has_type(node, "array")) return "std::vector<" + value_type(node.at("items")) + ">";
  if (has_type(node, "object")) {
    return "std::map<std::string, " + value_type(node.at("additionalProperties")) + ">";
  }
  if (has_type(node, "boolean")) return "bool";
  if (has_type(node, "integer")) return "std::int64_t";
  if (has_type(node, "number")) return "double";
  if (has_type(node, "string")) return "std::string";
  throw std::runtime_error("no C++ type for " + node.dump());
}

struct Member {
  std::string key;
  std::string name;
  std::string type;
  std::string initial;
  std::string description;
  bool may_be_absent = false;
};

// What the member of this type is before it is read.
std::string initial_of(const ordered_json& node, const std::string& type) {
  const ordered_json value = node.value("default", ordered_json());
  if (type == "bool") return value == true ? " = true" : " = false";
  if (type == "double" || type == "std::int64_t") {
    return " = " + (value.is_null() ? "0" : value.dump());
  }
  if (value.is_string() && node.contains("enum")) {
    return " = " + type + "::k" + camel_case(value.get<std::string>());
  }
  return "{}";
}

Member member_of(const std::string& key, const ordered_json& node) {
  Member member{.key = key,
                .name = node.value("x-name", key),
                .type = value_type(node),
                .initial = {},
                .description = node.value("description", "")};
  member.may_be_absent =
      node.contains("default") || node.contains("x-optional") || has_type(node, "null");
  if (member.may_be_absent && !node.contains("default") && !has_type(node, "array")) {
    member.type = "std::optional<" + member.type + ">";
    member.initial = "{}";
  } else {
    member.initial = initial_of(node, member.type);
  }
  return member;
}

bool same(const std::vector<Member>& a, const std::vector<Member>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].key != b[i].key || a[i].type != b[i].type) return false;
  }
  return true;
}

class Writer {
 public:
  // Writes what `node` and all below it need, the innermost first.
  void walk(const ordered_json& node) {
    if (!node.is_object()) return;
    if (node.contains("properties")) {
      for (const auto& [key, child] : node["properties"].items()) walk(child);
    }
    for (const char* const container : {"items", "additionalProperties"}) {
      if (node.contains(container)) walk(node[container]);
    }
    if (!node.contains("x-type")) return;
    if (node.contains("x-kinds")) {
      add_variant(node);
    } else if (node.contains("enum")) {
      add_enum(node);
    } else {
      add_struct(node);
    }
  }

  const std::string& enums() const { return enums_; }
  std::string structs() const { return structs_ + declarations_ + '\n'; }
  const std::string& functions() const { return functions_; }

 private:
  void add_enum(const ordered_json& node) {
    const std::string type = node["x-type"];
    const auto [known, is_new] = words_.emplace(type, node["enum"]);
    if (!is_new) {
      if (known->second != node["enum"]) throw std::runtime_error("two lists of words: " + type);
      return;
    }
    std::string values;
    std::string words;
    for (const ordered_json& word : node["enum"]) {
      const std::string value = "k" + camel_case(word.get<std::string>());
      values += (values.empty() ? "" : ", ") + value;
      words.append("      {").append(type).append("::").append(value).append(", ");
      words.append(word.dump()).append("},\n");
    }
    enums_ += comment(node.value("description", ""), "") + "enum class " + type +
              " : std::uint8_t { " + values + " };\n" + "constexpr auto words_of(" + type +
              ") {\n  return std::to_array<Word<" + type + ">>({\n" + words + "  });\n}\n\n";
  }

  void add_struct(const ordered_json& node) {
    const std::string type = node["x-type"];
    std::vector<Member> members;
    for (const auto& [key, child] : node.at("properties").items()) {
      members.push_back(member_of(key, child));
    }
    const auto [known, is_new] = members_.emplace(type, members);
    if (!is_new) {
      if (!same(known->second, members)) throw std::runtime_error("two structs: " + type);
      return;
    }
    std::string more;
    for (const ordered_json& line : node.value("x-declares", ordered_json::array())) {
      const auto text = line.get<std::string>();
      more += "  " + text + (text.starts_with("//") ? "\n" : ";\n");
    }
    declare(type, node.value("description", ""), members, more);
    add_reading(type, members);
  }

  void add_variant(const ordered_json& node) {
    const std::string variant = node["x-type"];
    const ordered_json& properties = node.at("properties");
    std::string types;
    std::vector<std::string> kinds;
    for (const auto& [kind, of_kind] : node["x-kinds"].items()) {
      const std::string type = camel_case(kind);
      kinds.push_back(kind);
      types += (types.empty() ? "" : ", ") + type;
      std::vector<Member> members;
      for (const ordered_json& key : of_kind.at("needs")) {
        ordered_json property = properties.at(key.get<std::string>());
        property.erase("x-optional");  // of the variant, not of this kind
        members.push_back(member_of(key, property));
        members.back().may_be_absent = true;  // until the checks refuse it
      }
      declare(type, of_kind.at("description"), members,
              "  static constexpr std::string_view kKind = \"" + kind + "\";\n");
      add_reading(type, members);
    }
    if (properties.at("kind").at("enum") != kinds) {
      throw std::runtime_error("the words of kind are not those of x-kinds: " + variant);
    }
    structs_ += comment(node.value("description", ""), "") + "using " + variant +
                " = std::variant<" + types + ">;\n\n";
  }

  void declare(const std::string& type, const std::string& description,
               const std::vector<Member>& members, const std::string& more) {
    structs_ += comment(description, "") + "struct " + type + " {\n";
    for (const Member& member : members) {
      structs_ += comment(member.description, "  ") + "  " + member.type + ' ' + member.name +
                  member.initial + ";\n";
    }
    structs_ += (more.empty() ? "" : "\n" + more) + "};\n\n";
    declarations_ += "void to_json(nlohmann::json& out, const " + type + "& value);\n" +
                     "void from_json(const nlohmann::json& in, " + type + "& value);\n";
  }

  void add_reading(const std::string& type, const std::vector<Member>& members) {
    std::string writing;
    std::string reading;
    for (const Member& member : members) {
      writing += "  out[\"" + member.key + "\"] = value." + member.name + ";\n";
      reading += std::string("  ") + (member.may_be_absent ? "read_if_there" : "read_member") +
                 "(in, \"" + member.key + "\", value." + member.name + ");\n";
    }
    functions_ += "void to_json(nlohmann::json& out, const " + type +
                  "& value) {\n  out = nlohmann::json::object();\n" + writing + "}\n" +
                  "void from_json(const nlohmann::json& in, " + type +
                  "& value) {\n  value = {};\n" + reading + "}\n\n";
  }

  std::map<std::string, ordered_json> words_;           // by enum
  std::map<std::string, std::vector<Member>> members_;  // by struct
  std::string enums_;
  std::string structs_;
  std::string declarations_;
  std::string functions_;
};

std::string as_header(const std::string& about, const std::string& includes,
                      const std::string& content) {
  return comment(about, "") + "#pragma once\n\n" + includes +
         "\nnamespace simbench::scenarios {\n\n" + content +
         "}  // namespace simbench::scenarios\n";
}

std::string choices_header(const Writer& writer) {
  return as_header("The choices of scenarios/schema.json, from which the build made this file.",
                   "#include <array>\n#include <cstdint>\n\n#include \"scenarios/words.h\"\n",
                   writer.enums());
}

std::string structs_header(const Writer& writer) {
  return as_header(
      "The structs of scenarios/schema.json, from which the build made this file. "
      "scenarios/scenario.h says what they are and has what their functions do.",
      "#include <cstdint>\n#include <map>\n#include <nlohmann/json_fwd.hpp>\n"
      "#include <optional>\n#include <string>\n#include <string_view>\n#include <variant>\n"
      "#include <vector>\n\n#include \"scenarios/choices.h\"\n",
      writer.structs());
}

std::string source(const Writer& writer) {
  return "#include \"scenarios/scenario_json.h\"\n\nnamespace simbench::scenarios {\n\n" +
         writer.functions() + "}  // namespace simbench::scenarios\n";
}

// A file that says the same already is left alone: what includes it need not be compiled anew.
void write(const std::string& path, const std::string& text) {
  std::stringstream present;
  present << std::ifstream(path).rdbuf();
  if (present.str() == text) return;
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 5) throw std::runtime_error("usage: SCHEMA CHOICES STRUCTS SOURCE");
  ordered_json schema = ordered_json::parse(std::ifstream(arguments[1]));
  simbench::scenarios::expand_references(schema);
  Writer writer;
  writer.walk(schema);
  write(arguments[2], choices_header(writer));
  write(arguments[3], structs_header(writer));
  write(arguments[4], source(writer));
  return 0;
} catch (const std::exception& error) {
  std::cerr << "scenario_members: " << error.what() << '\n';
  return 1;
}
