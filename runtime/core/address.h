// SPDX-License-Identifier: MIT
// Functions known by their addresses: the hooks of -finstrument-functions, which every compiler has.
#ifndef STIPPLE_RUNTIME_CORE_ADDRESS_H
#define STIPPLE_RUNTIME_CORE_ADDRESS_H

namespace stipple {

/// No more events of functions known by address. The lock is held.
void SilenceAddresses();

/// Switches each on or off as its region is (TokenOf). The lock is held.
void UpdateAddresses();

/// Around dlclose: until the end no address is taken for that of the function that was there.
void BeginUnload();
void EndUnload();

}  // namespace stipple

#endif
