"""Readers of OpenFAST's files: ElastoDyn, BeamDyn, and the primary file that names them."""
