// STUB, not pluginlib.
#pragma once

#define PLUGINLIB_EXPORT_CLASS(type, base)
