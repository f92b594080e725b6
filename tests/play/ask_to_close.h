// What the button of a window does that closes it.
#pragma once

namespace dreampm::play::test {

/// Sends the window of that id on the X server of DISPLAY the message that a window manager sends
/// (ICCCM 4.2.8.1, WM_DELETE_WINDOW). False where there is no server.
bool ask_to_close(unsigned long window);

}  // namespace dreampm::play::test
