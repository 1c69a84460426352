// SPDX-License-Identifier: MIT
// Where GCC meets us: the version check, the options, the two passes, the object block.
#include "plugin/gcc/gcc.h"

__attribute__((
    visibility("default"))) int plugin_is_GPL_compatible;  // GCC asks; the licence is MIT

namespace stipple::plugin {

Options options;

namespace {

Selection selection(options);
bool object_code_needed = false;

bool CanHoldEvents(function* fun) {
  const tree decl = fun->decl;
  // An extern inline function's body is only there to be inlined; the real one is elsewhere.
  return !DECL_EXTERNAL(decl) && lookup_attribute("naked", DECL_ATTRIBUTES(decl)) == NULL_TREE;
}

// Once per file, and only if there is something to register.
void AddObjectCode() {
  static bool added = false;
  if (added) return;
  added = true;
  std::string code(ObjectCode());
  if (ix86_asm_dialect == ASM_INTEL)
    code = "\t.att_syntax prefix\n" + code + "\t.intel_syntax noprefix\n";
  symtab->finalize_toplevel_asm(build_string(unsigned(code.size()), code.c_str()));
}

const pass_data kPassData = {
    GIMPLE_PASS, "stipple", OPTGROUP_NONE, TV_NONE, PROP_gimple_any, 0, 0, 0, 0,
};

template <Position position>
class EventPass : public gimple_opt_pass {
 public:
  explicit EventPass(gcc::context* context) : gimple_opt_pass(kPassData, context) {}

  bool gate(function*) override { return options.position == position; }

  unsigned int execute(function* fun) override {
    if (!CanHoldEvents(fun) || !selection.Select(FactsOf(fun)).instrument) return 0;
    if (position == Position::kSource) {
      InstrumentSequence(fun);
      AddObjectCode();
      return 0;
    }
    InstrumentGraph(fun);
    object_code_needed = true;
    return TODO_update_ssa | TODO_cleanup_cfg;
  }
};

// Without optimisation there is no such pass, and no need of it.
class PlacePass : public gimple_opt_pass {
 public:
  explicit PlacePass(gcc::context* context) : gimple_opt_pass(kPassData, context) {}

  unsigned int execute(function* fun) override {
    const bool preserve = flag_optimize_sibling_calls && options.tail_calls_preserved;
    const bool moved = preserve && LeaveBeforeTailCalls(fun);
    KeepLeavesAfterCalls(fun);
    const bool guarded = GuardEvents(fun);
    if (moved) return TODO_update_ssa | TODO_cleanup_cfg;
    return guarded ? TODO_update_ssa : 0;
  }
};

void RegisterPlacePass(const char* plugin) {
  register_pass_info info = {new PlacePass(g), "tailc", 1, PASS_POS_INSERT_BEFORE};
  register_callback(plugin, PLUGIN_PASS_MANAGER_SETUP, nullptr, &info);
}

template <Position position>
void Register(const char* plugin, const char* after) {
  register_pass_info info = {new EventPass<position>(g), after, 1, PASS_POS_INSERT_AFTER};
  register_callback(plugin, PLUGIN_PASS_MANAGER_SETUP, nullptr, &info);
}

// File-scope assembly of the program has been written when the late pass runs, so this goes
// straight into the output.
void WriteObjectCode(void*, void*) {
  if (!object_code_needed) return;
  const bool intel = ix86_asm_dialect == ASM_INTEL;
  fprintf(asm_out_file, "%s%.*s%s", intel ? "\t.att_syntax prefix\n" : "", int(ObjectCode().size()),
          ObjectCode().data(), intel ? "\t.intel_syntax noprefix\n" : "");
}

// As written, functions are selected before link-time optimisation, so the account has to travel
// the way of the program's own file-scope assembly; after inlining it goes straight into the
// output.
void AddAccount(void*, void*) {
  if (options.position != Position::kSource || selection.Account().empty()) return;
  const std::string code = AccountCode(selection.Account());
  symtab->finalize_toplevel_asm(build_string(unsigned(code.size()), code.c_str()));
}

void FinishAccount(void*, void*) {
  if (const std::string note = selection.Note(); !note.empty())
    fprintf(stderr, "%s\n", note.c_str());
  if (options.position == Position::kSource || selection.Account().empty()) return;
  fputs(AccountCode(selection.Account()).c_str(), asm_out_file);
}

const attribute_spec kAttributes[] = {
    {"xray_always_instrument", 0, 0, true, false, false, false, nullptr, nullptr},
    {"xray_never_instrument", 0, 0, true, false, false, false, nullptr, nullptr},
};

void RegisterAttributes(void*, void*) {
  for (const attribute_spec& attribute : kAttributes) register_attribute(&attribute);
}

// A text in the plugin's file, so that one can be asked what it is for, and a test can change it.
constexpr std::string_view kBuiltFor = "stipple plugin for GCC " STIPPLE_GCC_VERSION;

std::string BuiltFor() {
  const char* text = kBuiltFor.data();
  asm("" : "+r"(text));  // read the file's text, not what the compiler knows of it
  return text + strlen("stipple plugin for GCC ");
}

bool IsRightCompiler(plugin_gcc_version* compiler) {
  const std::string built_for = BuiltFor();
  const std::string is = compiler->basever;
  if (built_for == is && plugin_default_version_check(compiler, &gcc_version)) return true;
  if (built_for == is) {
    fprintf(stderr, "stipple: this plugin is for another build of GCC %s; build stipple again\n",
            is.c_str());
  } else {
    fprintf(stderr,
            "stipple: this plugin is for GCC %s, the compiler is %s; use the one in gcc-%s/\n",
            built_for.c_str(), is.c_str(), is.substr(0, is.find('.')).c_str());
  }
  return false;
}

bool ReadOptions(const plugin_name_args* plugin) {
  for (int i = 0; i < plugin->argc; ++i) {
    const plugin_argument& argument = plugin->argv[i];
    const auto problem =
        SetOption(options, argument.key, argument.value == nullptr ? "" : argument.value);
    if (!problem) continue;
    fprintf(stderr, "%s\n", problem->c_str());
    return false;
  }
  const auto problem = selection.ReadFilterFile();
  if (problem) fprintf(stderr, "%s\n", problem->c_str());
  return !problem;
}

}  // namespace
}  // namespace stipple::plugin

__attribute__((visibility("default"))) int plugin_init(plugin_name_args* plugin,
                                                       plugin_gcc_version* compiler) {
  using namespace stipple::plugin;
  if (!IsRightCompiler(compiler) || !ReadOptions(plugin)) exit(FATAL_EXIT_CODE);
  Register<Position::kSource>(plugin->base_name, "*warn_unused_result");
  Register<Position::kAfterInlining>(plugin->base_name, "ehdisp");
  RegisterPlacePass(plugin->base_name);
  register_callback(plugin->base_name, PLUGIN_ATTRIBUTES, RegisterAttributes, nullptr);
  register_callback(plugin->base_name, PLUGIN_FINISH_UNIT, WriteObjectCode, nullptr);
  register_callback(plugin->base_name, PLUGIN_ALL_IPA_PASSES_START, AddAccount, nullptr);
  register_callback(plugin->base_name, PLUGIN_FINISH_UNIT, FinishAccount, nullptr);
  return 0;
}
