/* SPDX-License-Identifier: MIT */
/* Where instrumented code jumps when its fast path does not fit; the protocol stands in
 * stipple/abi.h: eax = token, r11 = address to come back to; all registers but eax, rdx, r11 and the
 * flags are kept.
 *
 * Events written without the clock are done here in a few instructions. The samples among them, and
 * what a visit that is only counted cannot do itself, save the general registers and call
 * stipple_sample; everything else saves all registers and calls stipple_slow_event. For an unwinder this is a
 * function called from where r11 points; its stack pointer there is ours at the jump. The 128 bytes
 * below that may be the interrupted function's red zone. */
#include "stipple/abi.h"

	.hidden	stipple_stream
	.hidden	stipple_save_mask
	.hidden	stipple_save_bytes
	.hidden	stipple_slow_event
	.hidden	stipple_sample
	.hidden	stipple_sample_leave

	/* Steps over the red zone and saves the general registers that a call may change, and rbx;
	 * rbp leads to them. */
	.macro	SAVE
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
	movl	%eax, %ebx			/* token */
	movl	%eax, %edi
	leaq	144(%rbp), %rsi			/* stack pointer at the jump */
	.endm

	/* rdx: this thread's control block. */
	.macro	THIS_STREAM
#ifdef STIPPLE_SIMULATED
	movq	stipple_stream(%rip), %rdx
#else
	movq	stipple_stream@gottpoff(%rip), %rdx
	movq	%fs:(%rdx), %rdx
#endif
	.endm

	.text
	.p2align 6
	.globl	stipple_slow
	.hidden	stipple_slow
	.type	stipple_slow, @function
stipple_slow:
	.cfi_startproc
	.cfi_def_cfa rsp, 0
	.cfi_register rip, r11
	.cfi_remember_state

	/* No endbr64: the jump to here is not tracked. */
	testl	$STIPPLE_NO_CLOCK, %eax
	jnz	.Lno_clock
	xorl	%edx, %edx
	testl	$STIPPLE_COUNT_ONLY, %eax
	jnz	.Lask
	testl	$STIPPLE_SAMPLED, %eax
	jnz	.Lsample_leave

.Lgeneral:
	SAVE
.Lsaved:
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

	/* What may become a sample: by code that has no use for vector registers. It answers with the
	 * token, or with one that there is none of: then the general way is taken after all. */
.Ldue:
	.cfi_restore_state
	.cfi_remember_state
.Lask:
	SAVE					/* rdx: the counts that have been changed, or null */
	andq	$-64, %rsp
	call	stipple_sample
.Lsampled:
	cmpl	$-1, %eax
	movl	%ebx, %edi
	leaq	144(%rbp), %rsi
	je	.Lsaved
	movl	%eax, %ebx
	jmp	.Lback

.Lsample_leave:
	.cfi_restore_state
	.cfi_remember_state
	SAVE
	andq	$-64, %rsp
	call	stipple_sample_leave
	jmp	.Lsampled

	/* Reserve, but do not read the clock. An enter counts down to this thread's next sample of the
	 * region, too (sample.h). The token of an enter is the region and this one bit, so the bit is
	 * taken off in the address. */
.Lno_clock:
	.cfi_restore_state
	testl	$STIPPLE_LEAVE, %eax
	jnz	.Lappend
	THIS_STREAM
	movq	24(%rdx), %rdx			/* counts */
	testq	%rdx, %rdx
	jz	.Lask				/* no counts yet, or a sample is open */
	subl	$1, -8*STIPPLE_NO_CLOCK(%rdx,%rax,8)
	js	.Ldue
	subl	$1, -8*STIPPLE_NO_CLOCK+4(%rdx,%rax,8)
.Lappend:
	leaq	-128(%rsp), %rsp
	.cfi_def_cfa_offset 128
	pushq	%rcx
	.cfi_def_cfa_offset 136
	THIS_STREAM
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
