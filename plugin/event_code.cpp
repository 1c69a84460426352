// SPDX-License-Identifier: MIT
// abi.h states what this code does; here is why it is written this way.
//
// An event is one asm statement: it survives every pass, may be copied, and a leaf function stays a
// leaf. rdtsc fixes rax and rdx, the way back from the slow path fixes r11. The slow path is jumped
// to from a subsection behind the function; since nothing is pushed, red zone and unwind tables
// stay true. It comes back into the straight line, behind an instruction of it: to an unwinder in
// the slow path the way back is a return address, and that has to lie where the function's unwind
// table holds. The jump satisfies indirect-branch tracking, and the slow path comes back by a jump
// that is not tracked.
//
// A function that calls others anyway gets its events by a call too: two routines for each shared
// object hold the code, which is six times shorter at each event and costs the same time (a call
// and a return are hidden behind rdtsc). The stack pointer steps over the red zone meanwhile. The
// way to the slow path leaves the routine as if it had never been called, shadow stack included:
// the way back is again into the function.
//
// Visits that are only counted are many and short, so an enter counts them without the slow path:
// in its routine, or, in line, by a jump to a third one.
//
// The plugins put a test of the token around each event where they can, for the compiler to move
// the event out of the straight line: without a runtime an event is then a test and a branch not
// taken (a branch taken over the event costs a leaf 0.3 to 0.5 ns). The code tests again, for the
// places where there is no such test.
//
// The clock is tested for, not assumed: under a sparse clock most events end before rdtsc, which is
// 15 of the 16 ns of an event.
//
// The descriptor's section flag `?` puts it in the COMDAT group of the function, if there is one,
// so that a function the linker drops takes its descriptor along. A compiler may copy an enter; the
// copies' descriptors name the same region and the runtime gives them the same id.
#include "plugin/event_code.h"

#include <stddef.h>

#include <initializer_list>

#include "stipple/abi.h"

namespace stipple::plugin {
namespace {

// In the texts below ~t is the token's low half, ~q the whole register, ~u the number of the copy.

constexpr std::string_view kDescriptor = R"(
	.hidden	stipple_dso_1
	.pushsection	stipple_desc,"aw?",@progbits
	.balign	8
.Lstipple_slot~u:
	.long	0, ~line
	.quad	.Lstipple_name~u - .
	.quad	.Lstipple_file~u - .
	.popsection
	.pushsection	.rodata.stipple,"aMS?",@progbits,1
.Lstipple_name~u:
	.asciz	"~name"
.Lstipple_file~u:
	.asciz	"~file"
	.popsection
	movl	.Lstipple_slot~u(%rip), ~t
)";

constexpr std::string_view kTest = R"(
	testl	~t, ~t
	je	.Lstipple_done~u)";

constexpr std::string_view kAppend = R"(
	testl	$0xff000000, ~t
	jne	.Lstipple_cold~u
	movq	stipple_dso_1+8(%rip), %rax
	movq	%fs:(%rax), %rdx
	movl	$8, %r11d
	xaddq	%r11, (%rdx)
	xorl	%eax, %eax
	cmpq	8(%rdx), %r11
	jae	.Lstipple_cold~u
	testq	%r11, 16(%rdx)
	jne	.Lstipple_store~u
	rdtsc
	shlq	$24, %rax
	shlq	$56, %rdx
	orq	%rdx, %rax
.Lstipple_store~u:
	orq	~q, %rax
)";
constexpr std::string_view kMarkLeave = "\torq	$0x800000, %rax\n";
constexpr std::string_view kStore = "\tmovq	%rax, (%r11)\n";

constexpr std::string_view kFinishEnter = R"(
	movl	~t, %eax
.Lstipple_back~u:
	movl	%eax, ~t
.Lstipple_done~u:
	.subsection	1
.Lstipple_cold~u:
	movl	~t, %eax
	leaq	.Lstipple_back~u(%rip), %r11
	jmp	stipple_count_1
	.subsection	0
)";

constexpr std::string_view kFinishLeave = R"(
.Lstipple_done~u:
	.subsection	1
.Lstipple_cold~u:
	movl	~t, %eax
	orl	$0x800000, %eax
	leaq	.Lstipple_done~u(%rip), %r11
	notrack jmp	*stipple_dso_1+16(%rip)
	.subsection	0
)";

constexpr std::string_view kCallEnter = R"(
	movl	~t, %eax
	addq	$-128, %rsp
	call	stipple_enter_1
	subq	$-128, %rsp
	movl	%eax, ~t
.Lstipple_done~u:
)";

constexpr std::string_view kCallLeave = R"(
	movl	~t, %eax
	addq	$-128, %rsp
	call	stipple_leave_1
	subq	$-128, %rsp
.Lstipple_done~u:
)";

// The routines: token in r10, ~u is their name. To an unwinder the caller's stack pointer is what
// it was before it stepped over the red zone.
constexpr std::string_view kBeginRoutine = R"(
	.weak	stipple~u_1
	.hidden	stipple~u_1
	.type	stipple~u_1, @function
	.balign	16
stipple~u_1:
	.cfi_startproc
	.cfi_def_cfa	%rsp, 136
	.cfi_offset	%rip, -136
	movl	%eax, %r10d)";

// The bytes: rdsspq %rdx, which does nothing where there is no shadow stack, and incsspq %rdx. The
// four bytes that are skipped are the caller's `subq $-128, %rsp`.
constexpr std::string_view kFinishRoutine = R"(
	movl	%r10d, %eax
	ret
.Lstipple_cold~u:~count
	xorl	%edx, %edx
	.byte	0xf3, 0x48, 0x0f, 0x1e, 0xca
	testq	%rdx, %rdx
	je	.Lstipple_unwound~u
	movl	$1, %edx
	.byte	0xf3, 0x48, 0x0f, 0xae, 0xea
.Lstipple_unwound~u:
	movq	(%rsp), %r11
	addq	$4, %r11
	movl	%r10d, %eax
	~mark
	leaq	136(%rsp), %rsp
	.cfi_def_cfa_offset	0
	.cfi_register	%rip, %r11
	notrack jmp	*stipple_dso_1+16(%rip)
	.cfi_endproc
	.size	stipple~u_1, . - stipple~u_1
)";

// In an enter's cold part: a visit that is only counted ends here, unless the slow path has to know
// of it, which then finds the word as it was.
constexpr std::string_view kCount = R"(
	testl	$0x1000000, ~t
	je	.Lstipple_ask~u
	movq	stipple_dso_1+8(%rip), %rdx
	movq	%fs:(%rdx), %rdx
	movq	24(%rdx), %rdx
	testq	%rdx, %rdx
	je	.Lstipple_ask~u
	subl	$1, -0x8000000(%rdx,~q,8)
	js	.Lstipple_due~u
	xorl	%eax, %eax
	~return
.Lstipple_due~u:
	addl	$1, -0x8000000(%rdx,~q,8)
.Lstipple_ask~u:)";

// Where the cold part of an enter in line goes, with the slow path's registers.
constexpr std::string_view kBeginCount = R"(
	.weak	stipple_count_1
	.hidden	stipple_count_1
	.type	stipple_count_1, @function
	.balign	64
stipple_count_1:
	.cfi_startproc
	.cfi_def_cfa	%rsp, 0
	.cfi_register	%rip, %r11)";
constexpr std::string_view kFinishCount = R"(
	notrack jmp	*stipple_dso_1+16(%rip)
	.cfi_endproc
	.size	stipple_count_1, . - stipple_count_1
)";

static_assert(STIPPLE_COUNT_ONLY == 0x1000000 && offsetof(stipple_control, counts) == 24);
static_assert(STIPPLE_MODE_MASK == 0xff000000 && STIPPLE_LEAVE == 0x800000);
static_assert(offsetof(stipple_dso, tp_offset) == 8 && offsetof(stipple_dso, slow) == 16);
static_assert(offsetof(stipple_control, cur) == 0 && offsetof(stipple_control, end) == 8);
static_assert(offsetof(stipple_control, clock_mask) == 16);
static_assert(STIPPLE_ABI == 1 && sizeof(stipple_descriptor) == 24 && sizeof(stipple_dso) == 40);

// The runtime is found through the global offset table alone: a weak symbol referred to in any
// other way is taken for 0 when the linker makes an executable. The group's name holds the ABI, so
// that objects of two plugins can be linked together. A plain file-scope assembly knows no
// "already there" but this guard, and link-time optimisation joins those of all files.
constexpr std::string_view kBeginObject = R"(
	.ifndef	stipple_dso_1
	.weak	stipple_register
	.weak	stipple_unregister
	.weak	__start_stipple_desc
	.hidden	__start_stipple_desc
	.weak	__stop_stipple_desc
	.hidden	__stop_stipple_desc
	.pushsection	.data.stipple_dso_1,"awG",@progbits,stipple_dso_1,comdat
	.balign	8
	.weak	stipple_dso_1
	.hidden	stipple_dso_1
	.type	stipple_dso_1, @object
	.size	stipple_dso_1, 40
stipple_dso_1:
	.long	1, 24
	.quad	0, 0
	.quad	__start_stipple_desc
	.quad	__stop_stipple_desc
	.popsection
	.pushsection	.text.stipple_dso_1,"axG",@progbits,stipple_dso_1,comdat
	.type	.Lstipple_begin, @function
.Lstipple_begin:
	.cfi_startproc
	endbr64
	movq	stipple_register@GOTPCREL(%rip), %rax
	jmp	.Lstipple_call
	.cfi_endproc
	.type	.Lstipple_end, @function
.Lstipple_end:
	.cfi_startproc
	endbr64
	movq	stipple_unregister@GOTPCREL(%rip), %rax
.Lstipple_call:
	testq	%rax, %rax
	je	.Lstipple_return
	leaq	stipple_dso_1(%rip), %rdi
	jmp	*%rax
.Lstipple_return:
	ret
	.cfi_endproc
	.popsection
	.pushsection	.init_array.00001,"awG",@init_array,stipple_dso_1,comdat
	.balign	8
	.quad	.Lstipple_begin
	.popsection
	.pushsection	.fini_array.00001,"awG",@fini_array,stipple_dso_1,comdat
	.balign	8
	.quad	.Lstipple_end
	.popsection
	.pushsection	.text.stipple_event_1,"axG",@progbits,stipple_event_1,comdat
)";
constexpr std::string_view kEndObject = R"(
	.popsection
	.endif
)";

// Octal for all that means anything to an assembler or to a compiler's templates.
std::string Quoted(std::string_view text) {
  std::string quoted;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '_' || c == '.' || c == '/' || c == '-' || c == '+';
    if (plain) {
      quoted += c;
    } else {
      quoted += '\\';
      for (const int shift : {6, 3, 0}) quoted += static_cast<char>('0' + ((byte >> shift) & 7));
    }
  }
  return quoted;
}

void ReplaceAll(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
}

std::string Template(std::string text, const TemplateSyntax& syntax) {
  ReplaceAll(text, "%", syntax.percent);
  ReplaceAll(text, "$", syntax.dollar);
  ReplaceAll(text, "~t", syntax.token32);
  ReplaceAll(text, "~q", syntax.token64);
  ReplaceAll(text, "~u", syntax.unique);
  return std::string(syntax.begin) + text + std::string(syntax.end);
}

std::string Joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

/// `count`: the enter's counting. `mark`: the instruction that makes the slow path's token one of a
/// leave, if it is one.
std::string Routine(std::string_view name, std::string_view mark_word, std::string_view count,
                    std::string_view mark) {
  std::string text = Joined({kBeginRoutine, kAppend, mark_word, kStore, kFinishRoutine});
  ReplaceAll(text, "~count", count);
  ReplaceAll(text, "~return", "ret");
  ReplaceAll(text, "~mark", mark);
  return Template(text, {.begin = "",
                         .end = "",
                         .percent = "%",
                         .dollar = "$",
                         .token32 = "%r10d",
                         .token64 = "%r10",
                         .unique = name});
}

std::string CountRoutine() {
  std::string text = Joined({kBeginCount, kCount, kFinishCount});
  ReplaceAll(text, "~return", "notrack jmp\t*%r11");
  return Template(text, {.begin = "",
                         .end = "",
                         .percent = "%",
                         .dollar = "$",
                         .token32 = "%eax",
                         .token64 = "%rax",
                         .unique = "_count"});
}

}  // namespace

std::string SlotCode(const RegionText& region, const TemplateSyntax& syntax) {
  std::string text(kDescriptor);
  ReplaceAll(text, "~line", std::to_string(region.line));
  ReplaceAll(text, "~name", Quoted(region.name));
  ReplaceAll(text, "~file", Quoted(region.file));
  return Template(text, syntax);
}

std::string EnterCode(const TemplateSyntax& syntax, Form form) {
  return Template(form == Form::kInline ? Joined({kTest, kAppend, kStore, kFinishEnter})
                                        : Joined({kTest, kCallEnter}),
                  syntax);
}

std::string LeaveCode(const TemplateSyntax& syntax, Form form) {
  return Template(form == Form::kInline ? Joined({kTest, kAppend, kMarkLeave, kStore, kFinishLeave})
                                        : Joined({kTest, kCallLeave}),
                  syntax);
}

const std::string& ObjectCode() {
  static const std::string code = Joined({kBeginObject, Routine("_enter", "", kCount, ""),
                                          Routine("_leave", kMarkLeave, "", "orl\t$0x800000, %eax"),
                                          CountRoutine(), kEndObject});
  return code;
}

// Strings that the linker merges: what the files of a program say alike stands in it once.
std::string AccountCode(const std::set<std::string>& account) {
  std::string code = "\t.pushsection\t.stipple_left_out,\"MS\",@progbits,1\n";
  for (const std::string& text : account) code += "\t.asciz\t\"" + Quoted(text) + "\"\n";
  return code + "\t.popsection\n";
}

}  // namespace stipple::plugin
