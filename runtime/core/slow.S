/* SPDX-License-Identifier: MIT */
/* Where instrumented code jumps when its fast path does not fit; the protocol stands in
 * stipple/abi.h: eax = token, r11 = address to come back to; all registers but eax, rdx, r11 and the
 * flags are kept.
 *
 * Events that are only counted, or written without the clock, are done here in a few instructions.
 * Everything else saves the registers and calls stipple_slow_event. For an unwinder this is a
 * function called from where r11 points; its stack pointer there is ours at the jump. The 128 bytes
 * below that may be the interrupted function's red zone. */
#include "stipple/abi.h"

	.hidden	stipple_stream
	.hidden	stipple_save_mask
	.hidden	stipple_save_bytes
	.hidden	stipple_slow_event

	.text
	.p2align 5
	.globl	stipple_slow
	.hidden	stipple_slow
	.type	stipple_slow, @function
stipple_slow:
	.cfi_startproc
	.cfi_def_cfa rsp, 0
	.cfi_register rip, r11
	endbr64
	testl	$STIPPLE_MODE_MASK, %eax
	jnz	.Lmode

.Lgeneral:
	leaq	-128(%rsp), %rsp
	.cfi_def_cfa_offset 128
	pushq	%r11
	.cfi_def_cfa_offset 136
	.cfi_offset rip, -136
	pushq	%rbp
	.cfi_def_cfa_offset 144
	.cfi_offset rbp, -144
	movq	%rsp, %rbp
	.cfi_def_cfa_register rbp
	pushq	%rbx
	.cfi_offset rbx, -152
	pushq	%rcx
	pushq	%rdx
	pushq	%rsi
	pushq	%rdi
	pushq	%r8
	pushq	%r9
	pushq	%r10
	movl	%eax, %edi
	subq	stipple_save_bytes(%rip), %rsp
	andq	$-64, %rsp
	movl	stipple_save_mask(%rip), %eax
	movl	stipple_save_mask+4(%rip), %edx
	movl	%eax, %ecx
	orl	%edx, %ecx
	jz	.Lold_processor

	/* xrstor refuses a header that xsave has not filled unless it is zero. */
	xorl	%ecx, %ecx
	movq	%rcx, 512(%rsp)
	movq	%rcx, 520(%rsp)
	movq	%rcx, 528(%rsp)
	movq	%rcx, 536(%rsp)
	movq	%rcx, 544(%rsp)
	movq	%rcx, 552(%rsp)
	movq	%rcx, 560(%rsp)
	movq	%rcx, 568(%rsp)
	xsave64	(%rsp)
	ldmxcsr	.Lmxcsr(%rip)			/* the program may trap what we compute */
	call	stipple_slow_event
	movl	%eax, %ebx
	movl	stipple_save_mask(%rip), %eax
	movl	stipple_save_mask+4(%rip), %edx
	xrstor64	(%rsp)

.Lback:
	movl	%ebx, %eax
	leaq	-64(%rbp), %rsp
	popq	%r10
	popq	%r9
	popq	%r8
	popq	%rdi
	popq	%rsi
	popq	%rdx
	popq	%rcx
	popq	%rbx
	.cfi_restore rbx
	popq	%rbp
	.cfi_def_cfa rsp, 136
	.cfi_restore rbp
	popq	%r11
	.cfi_def_cfa_offset 128
	.cfi_register rip, r11
	leaq	128(%rsp), %rsp
	.cfi_def_cfa_offset 0
	notrack jmp	*%r11

.Lold_processor:
	.cfi_def_cfa rbp, 144
	.cfi_offset rip, -136
	.cfi_offset rbp, -144
	.cfi_offset rbx, -152
	fxsave64	(%rsp)
	ldmxcsr	.Lmxcsr(%rip)
	call	stipple_slow_event
	movl	%eax, %ebx
	fxrstor64	(%rsp)
	jmp	.Lback

	/* A mode bit is set: count, or reserve without reading the clock. */
.Lmode:
	.cfi_def_cfa rsp, 0
	.cfi_register rip, r11
	.cfi_restore rbp
	.cfi_restore rbx
	testl	$STIPPLE_COUNT_ONLY, %eax
	jz	.Lno_clock
	movq	stipple_stream@gottpoff(%rip), %rdx
	movq	%fs:(%rdx), %rdx
	movq	24(%rdx), %rdx			/* counts */
	testq	%rdx, %rdx
	jz	.Lgeneral
	testl	$STIPPLE_LEAVE, %eax
	jnz	.Lcounted
	andl	$STIPPLE_REGION_MASK, %eax
	incq	(%rdx,%rax,8)
.Lcounted:
	xorl	%eax, %eax
	notrack jmp	*%r11

.Lno_clock:
	testl	$STIPPLE_NO_CLOCK, %eax
	jz	.Lgeneral
	leaq	-128(%rsp), %rsp
	.cfi_def_cfa_offset 128
	pushq	%rcx
	.cfi_def_cfa_offset 136
	movq	stipple_stream@gottpoff(%rip), %rdx
	movq	%fs:(%rdx), %rdx
	movl	$8, %ecx
	xaddq	%rcx, (%rdx)			/* cur */
	cmpq	8(%rdx), %rcx			/* end */
	jae	.Lno_clock_full
	movl	%eax, %edx
	andl	$(STIPPLE_REGION_MASK | STIPPLE_LEAVE), %edx
	movq	%rdx, (%rcx)
	popq	%rcx
	.cfi_def_cfa_offset 128
	leaq	128(%rsp), %rsp
	.cfi_def_cfa_offset 0
	notrack jmp	*%r11
.Lno_clock_full:
	.cfi_def_cfa_offset 136
	popq	%rcx
	.cfi_def_cfa_offset 128
	leaq	128(%rsp), %rsp
	.cfi_def_cfa_offset 0
	jmp	.Lgeneral
	.cfi_endproc
	.size	stipple_slow, . - stipple_slow

	.section .rodata
	.p2align 2
.Lmxcsr:
	.long	0x1f80				/* as at the begin of a program: all masked, to nearest */

	.section .note.GNU-stack, "", @progbits
