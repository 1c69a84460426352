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

constexpr std::string_view kAppend = R"(
	testl	~t, ~t
	je	.Lstipple_done~u
	testl	$0xff000000, ~t
	jne	.Lstipple_cold~u
	movq	stipple_dso_1+8(%rip), %rax
	movq	%fs:(%rax), %rdx
	movl	$8, %eax
	xaddq	%rax, (%rdx)
	cmpq	8(%rdx), %rax
	jae	.Lstipple_cold~u
	movq	%rax, %r11
	testq	%rax, 16(%rdx)
	movl	$0, %eax
	jne	.Lstipple_store~u
	rdtsc
	shlq	$24, %rax
	shlq	$56, %rdx
	orq	%rdx, %rax
.Lstipple_store~u:)";

constexpr std::string_view kFinishEnter = R"(
	orq	~q, %rax
	movq	%rax, (%r11)
	movl	~t, %eax
.Lstipple_back~u:
	movl	%eax, ~t
.Lstipple_done~u:
	.subsection	1
.Lstipple_cold~u:
	movl	~t, %eax
	leaq	.Lstipple_back~u(%rip), %r11
	notrack jmp	*stipple_dso_1+16(%rip)
	.subsection	0
)";

constexpr std::string_view kFinishLeave = R"(
	orq	~q, %rax
	orq	$0x800000, %rax
	movq	%rax, (%r11)
.Lstipple_done~u:
	.subsection	1
.Lstipple_cold~u:
	movl	~t, %eax
	orl	$0x800000, %eax
	leaq	.Lstipple_done~u(%rip), %r11
	notrack jmp	*stipple_dso_1+16(%rip)
	.subsection	0
)";

static_assert(STIPPLE_MODE_MASK == 0xff000000 && STIPPLE_LEAVE == 0x800000);
static_assert(offsetof(stipple_dso, tp_offset) == 8 && offsetof(stipple_dso, slow) == 16);
static_assert(offsetof(stipple_control, cur) == 0 && offsetof(stipple_control, end) == 8);
static_assert(offsetof(stipple_control, clock_mask) == 16);
static_assert(STIPPLE_ABI == 1 && sizeof(stipple_descriptor) == 24 && sizeof(stipple_dso) == 40);

// The runtime is found through the global offset table alone: a weak symbol referred to in any
// other way is taken for 0 when the linker makes an executable. The group's name holds the ABI, so
// that objects of two plugins can be linked together. A plain file-scope assembly knows no
// "already there" but this guard, and link-time optimisation joins those of all files.
constexpr std::string_view kObject = R"(
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

}  // namespace

std::string SlotCode(const RegionText& region, const TemplateSyntax& syntax) {
  std::string text(kDescriptor);
  ReplaceAll(text, "~line", std::to_string(region.line));
  ReplaceAll(text, "~name", Quoted(region.name));
  ReplaceAll(text, "~file", Quoted(region.file));
  return Template(text, syntax);
}

std::string EnterCode(const TemplateSyntax& syntax) {
  return Template(std::string(kAppend) + std::string(kFinishEnter), syntax);
}

std::string LeaveCode(const TemplateSyntax& syntax) {
  return Template(std::string(kAppend) + std::string(kFinishLeave), syntax);
}

std::string_view ObjectCode() { return kObject; }

// Strings that the linker merges: what the files of a program say alike stands in it once.
std::string AccountCode(const std::set<std::string>& account) {
  std::string code = "\t.pushsection\t.stipple_left_out,\"MS\",@progbits,1\n";
  for (const std::string& text : account) code += "\t.asciz\t\"" + Quoted(text) + "\"\n";
  return code + "\t.popsection\n";
}

}  // namespace stipple::plugin
