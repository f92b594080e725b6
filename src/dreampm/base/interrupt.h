// Ctrl-C and SIGTERM become a flag that long loops ask for between units of work.
#pragma once
namespace dreampm {

/// Installs the handlers; a second signal ends the process at once.
void catch_interrupts();
/// True once a signal came.
bool signal_caught();
/// True if the current host wants work to stop.
bool interrupted();

}  // namespace dreampm
