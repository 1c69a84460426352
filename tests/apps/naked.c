/* SPDX-License-Identifier: MIT */
/* A naked function has no room for events and must come through untouched. */
#include <stdio.h>

__attribute__((naked, noinline)) int Naked(void) { __asm__("movl $42, %eax\n\tret"); }
__attribute__((noinline)) int Dressed(void) { return Naked() + printf("dressed\n"); }

int main(void) { return Dressed() == 50 ? 0 : 1; }
