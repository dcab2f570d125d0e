"""Text tables of SAP2000 (.s2k, .$2k)."""

from rga.importing.sap2000.read import read_sap2000

__all__ = ["read_sap2000"]
