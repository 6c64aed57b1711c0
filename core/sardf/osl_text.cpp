#include "sardf/osl_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "sardf/bake_channels.hpp"
#include "sardf/error.hpp"
#include "sardf/graph.hpp"
#include "sardf/number_text.hpp"

namespace sardf {
namespace {

/// OSL's numbers are floats, and it has no word for infinity.
std::string osl_number(double value) {
  constexpr double largest = 3.4e38;
  const double limited = std::clamp(value, -largest, largest);
  std::string text;
  append_number(text, static_cast<float>(std::isnan(value) ? 0 : limited));
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text[0] == '-' ? "(" + text + ")" : text;
}

bool is_mask(const TraceStep& step) {
  return step.kind == TraceStep::Kind::call &&
         (step.name == "<" || step.name == "<=" || step.name == "and" || step.name == "or" ||
          step.name == "not");
}

/// The steps of a record as statements, each of one local variable.
class StepPrinter {
 public:
  explicit StepPrinter(const Trace& trace) : trace_(trace) {}

  std::string body() const {
    std::vector<bool> needed(trace_.steps().size(), false);
    needed[size_t(trace_.result)] = true;
    for (size_t i = needed.size(); i-- > 0;)
      for (const int operand : trace_[int(i)].operands)
        if (needed[i] && operand >= 0) needed[size_t(operand)] = true;
    std::string out;
    for (size_t i = 0; i < needed.size(); ++i) {
      const TraceStep& step = trace_[int(i)];
      if (!needed[i] || is_leaf(step)) continue;
      out += std::string("    ") + (is_mask(step) ? "int" : "float") + " " + variable(int(i)) +
             " = " + text(step) + ";\n";
    }
    return out + "    return " + use(trace_.result) + ";\n";
  }

 private:
  static bool is_leaf(const TraceStep& step) {
    return step.kind == TraceStep::Kind::input || step.kind == TraceStep::Kind::number;
  }
  static std::string variable(int step) { return "t" + std::to_string(step); }

  std::string use(int i) const {
    const TraceStep& step = trace_[i];
    if (step.kind == TraceStep::Kind::input) return "a" + std::to_string(step.index);
    if (step.kind == TraceStep::Kind::number) return osl_number(step.value);
    return variable(i);
  }

  std::string text(const TraceStep& step) const {
    const std::string a = use(step.operands[0]);
    const std::string b = step.operands[1] >= 0 ? use(step.operands[1]) : "";
    if (step.kind != TraceStep::Kind::call) return a + " ? " + b + " : " + use(step.operands[2]);
    static const std::map<std::string, std::string> infix{{"+", "+"},    {"-", "-"},  {"*", "*"},
                                                          {"/", "/"},    {"<", "<"},  {"<=", "<="},
                                                          {"and", "&&"}, {"or", "||"}};
    if (const auto known = infix.find(step.name); known != infix.end())
      return a + " " + known->second + " " + b;
    if (step.name == "negate") return "-" + a;
    if (step.name == "not") return "!" + a;
    return step.name + "(" + a + (b.empty() ? "" : ", " + b) + ")";
  }

  const Trace& trace_;
};

/// Gives out identifiers; a word that was given or that OSL keeps gets a number.
class Identifiers {
 public:
  std::string unique(const std::string& word) {
    std::string base;
    for (const char c : word) base += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    if (base.empty() || std::isdigit(static_cast<unsigned char>(base[0])) || base[0] == '_')
      base = "m" + base;
    std::string name = base;
    for (int n = 2; !taken_.insert(name).second; ++n) name = base + "_" + std::to_string(n);
    return name;
  }

 private:
  // Reserved words and global variables of the specification, sections 2 and 8.
  std::set<std::string> taken_{
      "and",          "break",   "closure", "color",    "continue", "do",
      "else",         "emit",    "float",   "for",      "if",       "illuminance",
      "illuminate",   "int",     "matrix",  "normal",   "not",      "or",
      "output",       "point",   "public",  "return",   "string",   "struct",
      "vector",       "void",    "while",   "bool",     "case",     "char",
      "class",        "const",   "default", "double",   "enum",     "extern",
      "false",        "friend",  "inline",  "long",     "private",  "protected",
      "short",        "signed",  "sizeof",  "static",   "switch",   "template",
      "this",         "true",    "typedef", "uniform",  "union",    "unsigned",
      "varying",      "virtual", "P",       "I",        "N",        "Ng",
      "dPdu",         "dPdv",    "Ps",      "u",        "v",        "time",
      "dtime",        "dPdtime", "Ci",      "p",        "shader",   "surface",
      "displacement", "volume",  "M_PI",    "distance", "length",   "noise",
      "mix"};
};

/// Prints a scene's channels.
class ShaderPrinter {
 public:
  std::string function_of(const Operation& operation) {
    const auto [known, added] =
        functions_.try_emplace({operation.info().name, operation.numbers()});
    if (added) {
      // Of their own kind: no variable is called so.
      known->second = "sardf_" + operation.info().name + "_" + std::to_string(functions_.size());
      declarations_ += osl_function(known->second, operation) + "\n";
    }
    return known->second;
  }

  /// Statements that compute the roots; returns the roots' texts.
  std::vector<std::string> compute(const std::vector<Expression>& roots) {
    std::unordered_map<const Node*, std::string> value;
    for (const Node* node : topological_order(roots)) {
      if (node->type == Node::Type::constant) {
        value[node] = osl_number(node->value);
      } else if (node->type == Node::Type::coordinate) {
        value[node] = "p[" + std::to_string(node->axis) + "]";
      } else {
        std::string inputs;
        for (const Expression& input : node->arguments())
          inputs += (inputs.empty() ? "" : ", ") + value.at(input.get());
        const std::string name = "sardf_v" + std::to_string(value.size());
        statements_ +=
            "    float " + name + " = " + function_of(*node->operation) + "(" + inputs + ");\n";
        value[node] = name;
      }
    }
    std::vector<std::string> texts;
    for (const Expression& root : roots) texts.push_back(value.at(root.get()));
    return texts;
  }

  const std::string& declarations() const { return declarations_; }
  const std::string& statements() const { return statements_; }

 private:
  std::map<std::pair<std::string, std::vector<double>>, std::string> functions_;
  std::string declarations_, statements_;
};

std::vector<OslOutput> outputs_of(const Scene& scene, const std::vector<BakeChannel>& channels) {
  Identifiers identifiers;
  std::vector<OslOutput> outputs;
  for (const BakeChannel& channel : channels) {
    const std::vector<std::string> materials = materials_of_channel(scene, channel.name);
    const size_t n = channel.components.size();
    if (is_color_channel(channel.name)) {
      outputs.push_back({identifiers.unique(channel.name), channel.name, true});
    } else if (!materials.empty()) {
      for (const std::string& material : materials)
        outputs.push_back({identifiers.unique("fraction_" + material), material, false});
    } else {
      for (size_t c = 0; c < n; ++c) {
        const std::string name = n == 1 ? channel.name : channel.name + "_" + std::to_string(c + 1);
        outputs.push_back({identifiers.unique(name), name, false});
      }
    }
  }
  return outputs;
}

}  // namespace

std::string osl_function(const std::string& name, const Operation& operation) {
  const OperationInfo& info = operation.info();
  if (!operation.has_formula())
    throw Error("'" + info.name +
                "' has no formula that OSL could evaluate; bake it into textures instead");
  std::string signature;
  for (int i = 0; i < info.arity; ++i)
    signature += (i > 0 ? ", float a" : "float a") + std::to_string(i);
  Trace trace(info.arity);
  operation.record(trace);
  return "float " + name + "(" + signature + ") {\n" + StepPrinter(trace).body() + "}\n";
}

OslShader osl_shader(const Scene& scene, const std::vector<std::string>& channels,
                     const std::string& name) {
  const std::vector<BakeChannel> wanted = scene_channels(scene, channels);
  std::vector<Expression> roots;
  for (const BakeChannel& channel : wanted) {
    if (channel.tangent_normal)
      throw Error("'" + channel.name + "' is no channel of a shader: it shades by the mesh's own");
    const std::vector<std::string> materials = materials_of_channel(scene, channel.name);
    const size_t n = materials.empty() ? channel.components.size() : materials.size();
    roots.insert(roots.end(), channel.components.begin(), channel.components.begin() + long(n));
  }
  OslShader shader;
  shader.outputs = outputs_of(scene, wanted);
  ShaderPrinter printer;
  const std::vector<std::string> texts = printer.compute(roots);
  std::string parameters, results;
  size_t at = 0;
  for (const OslOutput& output : shader.outputs) {
    parameters += (parameters.empty() ? "" : ",\n    ") +
                  std::string(output.is_color ? "output color " : "output float ") + output.name +
                  " = 0";
    results += "    " + output.name + " = ";
    results += output.is_color
                   ? "color(" + texts[at] + ", " + texts[at + 1] + ", " + texts[at + 2] + ");\n"
                   : texts[at] + ";\n";
    at += output.is_color ? 3 : 1;
  }
  shader.text = printer.declarations() + "shader " + name + "(\n    " + parameters +
                ") {\n    point p = transform(\"object\", P);\n" + printer.statements() + results +
                "}\n";
  return shader;
}

}  // namespace sardf
