"""The printed parts as code for a CAD kernel; needs fdvv-rig[cad]."""
