#pragma once

namespace pointgi {

/// For the device's loop, which asks; elsewhere Ctrl-C ends the program as usual. From now on Ctrl-C and SIGTERM only
/// ask to stop, once: a second one ends the program at once.
void catch_interrupts();

/// Whether stopping was asked for.
bool interrupted();

} // namespace pointgi
