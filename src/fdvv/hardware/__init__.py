"""The rig as things to make and buy: parts, circuit, bill of materials, and which part is wrong."""
