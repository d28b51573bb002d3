#pragma once

namespace pointgi {

/// From now on Ctrl-C and SIGTERM only ask to stop, once: a second one ends the program at once.
void catch_interrupts();

/// Whether stopping was asked for.
bool interrupted();

} // namespace pointgi
