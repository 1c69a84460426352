/* SPDX-License-Identifier: MIT */
/* setjmp and longjmp, contexts, vfork: noted on their way to libc.
 *
 * A function that returns twice must return to its caller's frame, so each of these jumps to the real
 * one, the caller's return address in place: masks, shadow stacks and stack checks are libc's own
 * matter. A thread that has recorded nothing pays for a load, a comparison and a jump. */

	.hidden	stipple_stream
	.hidden	stipple_no_stream
	.hidden	stipple_note_jump_point
	.hidden	stipple_note_longjmp
	.hidden	stipple_note_switch
	.hidden	stipple_note_context_end
	.hidden	stipple_note_unwound
	.hidden	stipple_next_jump
	.hidden	stipple_jumps
	.hidden	stipple_start_context

/* Goes to \to when the thread has no stream. */
.macro unless_recorded to
	movq	stipple_stream@gottpoff(%rip), %rax
	movq	%fs:(%rax), %rax
	leaq	stipple_no_stream(%rip), %r11
	cmpq	%r11, %rax
	je	\to
.endm

/* Around a call of a note: the first two arguments are kept. In between, the stack pointer that the
 * caller goes on with is rsp + 32. */
.macro begin_note
	pushq	%rdi
	.cfi_adjust_cfa_offset 8
	pushq	%rsi
	.cfi_adjust_cfa_offset 8
	subq	$8, %rsp
	.cfi_adjust_cfa_offset 8
.endm
.macro end_note
	addq	$8, %rsp
	.cfi_adjust_cfa_offset -8
	popq	%rsi
	.cfi_adjust_cfa_offset -8
	popq	%rdi
	.cfi_adjust_cfa_offset -8
.endm

.macro function name
	.globl	\name
	.type	\name, @function
	.p2align 4
\name:
	.cfi_startproc
	endbr64
.endm
/* On to the real function, number \index of stipple_jumps. */
.macro go_on name, index
	movq	stipple_jumps+8*\index(%rip), %r11
	testq	%r11, %r11
	jz	3f
	jmp	*%r11
3:	begin_note
	movl	$\index, %edi
	call	stipple_next_jump
	end_note
	jmp	*%rax
	.cfi_endproc
	.size	\name, . - \name
.endm

/* The program may come back to where this returns. */
.macro point name, index
	function \name
	unless_recorded 1f
	begin_note
	leaq	32(%rsp), %rdi
	call	stipple_note_jump_point
	end_note
1:	go_on	\name, \index
.endm

.macro longjmp name, index
	function \name
	unless_recorded 1f
	begin_note
	call	stipple_note_longjmp
	end_note
1:	go_on	\name, \index
.endm

	.text
	/* In the order of kNames in jumps.cpp. */
	point	setjmp, 0
	point	_setjmp, 1
	point	__sigsetjmp, 2
	point	getcontext, 3
	longjmp	longjmp, 4
	longjmp	_longjmp, 5
	longjmp	siglongjmp, 6
	longjmp	__longjmp_chk, 7

	function swapcontext
	unless_recorded 1f
	begin_note
	leaq	32(%rsp), %rdi
	call	stipple_note_switch
	end_note
1:	go_on	swapcontext, 8

	function setcontext
	unless_recorded 1f
	begin_note
	movq	%rdi, %rsi
	leaq	32(%rsp), %rdi
	call	stipple_note_switch
	end_note
1:	go_on	setcontext, 9

/* The child runs on the parent's stack and in its stream: when the parent goes on, what the child had
 * entered is left. The return address waits in rdi, as in libc: the child overwrites that on the stack.
 * With a shadow stack only libc knows how. */
	function vfork
	unless_recorded 1f
	testl	$2, %fs:72
	jnz	1f
	begin_note
	leaq	32(%rsp), %rdi
	call	stipple_note_jump_point
	end_note
	popq	%rdi
	.cfi_adjust_cfa_offset -8
	.cfi_register rip, rdi
	movl	$58, %eax
	syscall
	pushq	%rdi
	.cfi_adjust_cfa_offset 8
	.cfi_offset rip, -8
	testl	%eax, %eax
	js	1f				/* libc's fails, too, and sets errno */
	jz	2f
	pushq	%rax
	.cfi_adjust_cfa_offset 8
	leaq	16(%rsp), %rdi
	call	stipple_note_unwound
	popq	%rax
	.cfi_adjust_cfa_offset -8
2:	ret
1:	go_on	vfork, 10

/* What the function of a context returns to, instead of libc's code that goes on with the next
 * context: rbx points to the place of its address. Nothing is above in an unwinder's eyes. */
	.globl	stipple_context_end
	.hidden	stipple_context_end
	.type	stipple_context_end, @function
	.cfi_startproc
	.cfi_undefined rip
	nop
stipple_context_end:
	movq	%rsp, %rdi
	movq	(%rbx), %rsi
	andq	$-16, %rsp
	call	stipple_note_context_end
	jmp	*stipple_start_context(%rip)
	.cfi_endproc
	.size	stipple_context_end, . - stipple_context_end

	.section .note.GNU-stack, "", @progbits
