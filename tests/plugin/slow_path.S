/* SPDX-License-Identifier: MIT */
/* The slow path of test doubles of the runtime: `test_slow_event(token)` as a function of C, with the red zone and every
   register but rax, rdx and r11 kept. */
	.text
	.hidden	test_slow_path
	.globl	test_slow_path
	.type	test_slow_path, @function
test_slow_path:
	endbr64
	leaq	-128(%rsp), %rsp
	pushq	%rbp
	pushq	%rcx
	pushq	%rsi
	pushq	%rdi
	pushq	%r8
	pushq	%r9
	pushq	%r10
	pushq	%r11
	movq	%rsp, %rbp
	subq	$512, %rsp
	andq	$-64, %rsp
	fxsave64	(%rsp)
	movl	%eax, %edi
	cld
	call	test_slow_event
	fxrstor64	(%rsp)
	movq	%rbp, %rsp
	popq	%r11
	popq	%r10
	popq	%r9
	popq	%r8
	popq	%rdi
	popq	%rsi
	popq	%rcx
	popq	%rbp
	leaq	128(%rsp), %rsp
	notrack jmp	*%r11
	.size	test_slow_path, .-test_slow_path
	.section	.note.GNU-stack, "", @progbits
