// SPDX-License-Identifier: MIT
#include "analysis/trace/demangle.h"

#include <cxxabi.h>

#include <array>
#include <cstdlib>
#include <memory>

namespace stipple {
namespace {

/// What compilers append to the copies that they make of a function.
constexpr std::array<std::string_view, 8> kCloneSuffixes = {
    ".constprop.", ".isra.", ".part.", ".cold", ".lto_priv.", ".localalias", ".llvm.", ".clone."};

std::string_view WithoutClone(std::string_view name) {
  for (const std::string_view suffix : kCloneSuffixes)
    if (const std::size_t at = name.find(suffix); at != 0 && at != std::string_view::npos)
      name = name.substr(0, at);
  return name;
}

/// gfortran: __MODULE_MOD_PROCEDURE.
std::string FortranName(std::string_view name) {
  constexpr std::string_view kMod = "_MOD_";
  const std::size_t at = name.find(kMod);
  if (name.substr(0, 2) != "__" || at == std::string_view::npos || at <= 2) return {};
  return std::string(name.substr(2, at - 2)) + "::" + std::string(name.substr(at + kMod.size()));
}

constexpr std::string_view kUnnamed = "(anonymous namespace)::";
constexpr std::string_view kOperator = "operator";

/// How many characters of `text` from `at` on belong to an operator's name, whose brackets open
/// nothing: "operator()", "operator<<", "operator->"; 0 if none begins there.
std::size_t OperatorBytes(std::string_view text, std::size_t at) {
  if (text.substr(at, kOperator.size()) != kOperator) return 0;
  std::size_t end = at + kOperator.size();
  if (text.substr(end, 2) == "()") return kOperator.size() + 2;
  while (end < text.size() && std::string_view("<>=-+*/%^&|~![],").find(text[end]) != text.npos)
    ++end;
  return end - at;
}

}  // namespace

std::string ShortName(std::string_view demangled) {
  std::string name;
  int angles = 0;
  bool is_operator = false;
  int braces = 0;  // of a lambda, whose parameters belong to its name
  // Without parameters it is no signature: a program's own region may be called "main phase".
  const bool has_return_type = demangled.find('(') != std::string_view::npos;
  for (std::size_t i = 0; i < demangled.size(); ++i) {
    const char c = demangled[i];
    const std::size_t operator_bytes = angles == 0 ? OperatorBytes(demangled, i) : 0;
    if (operator_bytes > 0) {
      name += demangled.substr(i, operator_bytes);
      i += operator_bytes - 1;
      is_operator = true;
    } else if (demangled.substr(i, kUnnamed.size()) == kUnnamed) {
      i += kUnnamed.size() - 1;
    } else if (c == '<') {
      if (angles++ == 0) name += "<..>";
    } else if (c == '>') {
      angles -= angles > 0 ? 1 : 0;
    } else if (angles == 0) {
      braces += c == '{' ? 1 : c == '}' ? -1 : 0;
      if (c == '(' && braces == 0) break;
      // What stood before a blank was the return type, but for "operator new", "operator<< <char>".
      if (c == ' ' && braces == 0 && !is_operator && has_return_type) {
        name.clear();
      } else if (c != ' ' || braces > 0 || demangled.substr(i + 1, 1) != "<") {
        name += c;
      }
    }
  }
  return name.empty() ? std::string(demangled) : name;
}

std::string Demangle(std::string_view linkage_name) {
  const std::string name(WithoutClone(linkage_name));
  if (name.starts_with("_Z")) {
    int status = 0;
    const std::unique_ptr<char, decltype(&std::free)> text(
        abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status), &std::free);
    if (status == 0 && text != nullptr) return text.get();
  }
  if (std::string fortran = FortranName(name); !fortran.empty()) return fortran;
  return name;
}

}  // namespace stipple
