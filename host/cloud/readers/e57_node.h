#pragma once
/// Values in the description (XML) of an E57 file, which leaves out what is 0.
#include "host/cloud/readers/e57_file.h"
#include "host/cloud/readers/xml_tree.h"
#include <Eigen/Geometry>

namespace pointgi {

/// The attribute type: "Structure", "Vector", "Integer" …; empty where it is missing.
std::string e57_type(const XmlNode& node);

/// Attributes; `otherwise` where they are missing. Throws Error(input) for what is no (finite) number.
std::int64_t e57_integer(const E57File& file, const XmlNode& node, const char* attribute, std::int64_t otherwise);
double e57_real(const E57File& file, const XmlNode& node, const char* attribute, double otherwise);

/// The content of the child of a structure, 0 where it is empty, `otherwise` where there is no such child. Of a
/// ScaledInteger the scaled value. Throws Error(input) for what is no finite number.
double e57_number(const E57File& file, const XmlNode& structure, const char* child, double otherwise);

/// From a scan's frame to the file's: pose, the identity where it or a part of it is missing.
Eigen::Isometry3d e57_pose(const E57File& file, const XmlNode& scan);

} // namespace pointgi
