# SPDX-License-Identifier: MIT
# Under Syscall User Dispatch only the core's own code may make system calls unseen (runtime/system/
# dispatch.cpp). What the dispatcher must do itself it therefore does here.
	.text

# long stipple_pass_call(long number, const long arguments[6])
	.globl stipple_pass_call
	.type stipple_pass_call, @function
stipple_pass_call:
	.cfi_startproc
	endbr64
	movq %rdi, %rax
	movq %rsi, %rcx
	movq 0(%rcx), %rdi
	movq 8(%rcx), %rsi
	movq 16(%rcx), %rdx
	movq 24(%rcx), %r10
	movq 32(%rcx), %r8
	movq 40(%rcx), %r9
	syscall
	ret
	.cfi_endproc
	.size stipple_pass_call, . - stipple_pass_call

# Where the dispatcher's handler returns to. Unwinders know a signal's frame by these very bytes; there
# is no unwind table for it.
	.globl stipple_pass_return
	.type stipple_pass_return, @function
	nop
stipple_pass_return:
	movq $15, %rax
	syscall
	.size stipple_pass_return, . - stipple_pass_return

# void stipple_pass_return_from(void* stack): ends the signal handler of the program whose frame lies there
	.globl stipple_pass_return_from
	.type stipple_pass_return_from, @function
stipple_pass_return_from:
	endbr64
	movq %rdi, %rsp
	movq $15, %rax
	syscall
	.size stipple_pass_return_from, . - stipple_pass_return_from

	.section .note.GNU-stack, "", @progbits
