/* SPDX-License-Identifier: MIT */
/* slow_test.cpp: registers through the slow path.
 * rdi = slow, esi = token, rdx = from, rcx = to, r8d = whether ymm. */
	.text
	.globl	slow_registers
	.type	slow_registers, @function
slow_registers:
	pushq	%rbx
	pushq	%rbp
	pushq	%r12
	pushq	%r13
	pushq	%r14
	pushq	%r15
	subq	$56, %rsp
	movq	%rcx, 0(%rsp)			/* to */
	movq	%r8, 8(%rsp)
	movq	%rdi, 16(%rsp)
	movl	%esi, %eax
	fldt	640(%rdx)
	testl	%r8d, %r8d
	jz	1f
	.irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15
	vmovdqu	128+32*\n(%rdx), %ymm\n
	.endr
	jmp	2f
1:	.irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15
	movdqu	128+32*\n(%rdx), %xmm\n
	.endr
2:	movq	96(%rdx), %rbx
	movq	%rbx, -8(%rsp)			/* the red zone */
	movq	0(%rdx), %rbx
	movq	8(%rdx), %rcx
	movq	16(%rdx), %rsi
	movq	24(%rdx), %rdi
	movq	32(%rdx), %r8
	movq	40(%rdx), %r9
	movq	48(%rdx), %r10
	movq	56(%rdx), %r12
	movq	64(%rdx), %r13
	movq	72(%rdx), %r14
	movq	80(%rdx), %r15
	movq	88(%rdx), %rbp
	leaq	3f(%rip), %r11
	jmp	*16(%rsp)
3:	movq	0(%rsp), %rdx
	movq	%rbx, 0(%rdx)
	movq	%rcx, 8(%rdx)
	movq	%rsi, 16(%rdx)
	movq	%rdi, 24(%rdx)
	movq	%r8, 32(%rdx)
	movq	%r9, 40(%rdx)
	movq	%r10, 48(%rdx)
	movq	%r12, 56(%rdx)
	movq	%r13, 64(%rdx)
	movq	%r14, 72(%rdx)
	movq	%r15, 80(%rdx)
	movq	%rbp, 88(%rdx)
	movq	-8(%rsp), %rbx
	movq	%rbx, 96(%rdx)
	fstpt	640(%rdx)
	cmpl	$0, 8(%rsp)
	je	4f
	.irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15
	vmovdqu	%ymm\n, 128+32*\n(%rdx)
	.endr
	vzeroupper
	jmp	5f
4:	.irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15
	movdqu	%xmm\n, 128+32*\n(%rdx)
	.endr
5:	addq	$56, %rsp
	popq	%r15
	popq	%r14
	popq	%r13
	popq	%r12
	popq	%rbp
	popq	%rbx
	ret
	.size	slow_registers, . - slow_registers

/* rdi = slow, esi = token, rdx = from, rcx = to: MXCSR and the control word of the x87. */
	.globl	slow_control_words
	.type	slow_control_words, @function
slow_control_words:
	subq	$24, %rsp
	movq	%rcx, 0(%rsp)
	stmxcsr	8(%rsp)
	fnstcw	12(%rsp)
	movl	%esi, %eax
	ldmxcsr	0(%rdx)
	fldcw	4(%rdx)
	leaq	1f(%rip), %r11
	jmp	*%rdi
1:	movq	0(%rsp), %rdx
	stmxcsr	0(%rdx)
	fnstcw	4(%rdx)
	ldmxcsr	8(%rsp)
	fldcw	12(%rsp)
	addq	$24, %rsp
	ret
	.size	slow_control_words, . - slow_control_words

/* rdi = slow, esi = token, rdx = from, rcx = to: zmm0 to zmm31, then k0 to k7. */
	.globl	slow_zmm
	.type	slow_zmm, @function
slow_zmm:
	subq	$8, %rsp
	movq	%rcx, 0(%rsp)
	movl	%esi, %eax
	.irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31
	vmovdqu64	64*\n(%rdx), %zmm\n
	.endr
	.irp n, 0,1,2,3,4,5,6,7
	kmovq	2048+8*\n(%rdx), %k\n
	.endr
	leaq	1f(%rip), %r11
	jmp	*%rdi
1:	movq	0(%rsp), %rdx
	.irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31
	vmovdqu64	%zmm\n, 64*\n(%rdx)
	.endr
	.irp n, 0,1,2,3,4,5,6,7
	kmovq	%k\n, 2048+8*\n(%rdx)
	.endr
	vzeroupper
	addq	$8, %rsp
	ret
	.size	slow_zmm, . - slow_zmm

/* rdi = slow, esi = token, rdx = tile configuration, rcx = from, r8 = to: tile 0, 16 rows of 64 bytes. */
	.globl	slow_tiles
	.type	slow_tiles, @function
slow_tiles:
	movl	%esi, %eax
	movl	$64, %r9d
	ldtilecfg	(%rdx)
	tileloadd	(%rcx,%r9,1), %tmm0
	leaq	1f(%rip), %r11
	jmp	*%rdi
1:	tilestored	%tmm0, (%r8,%r9,1)
	tilerelease
	ret
	.size	slow_tiles, . - slow_tiles
	.section .note.GNU-stack, "", @progbits
