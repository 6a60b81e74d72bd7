// name: robots-that-differ
// kind: table
// description: Which robots have other findings, or other open elements, than most robots of their model have?
// returns robot: string, name of the robot
// returns model: string, its model; empty for robots without one, which are compared with each other
// returns more_findings: list of string, what it has and most robots do not, without dismissed findings; 'elsewhere' stands behind a source that is not on it
// returns fewer_findings: list of string, what most robots have and it does not
// returns more_open: list of string, elements that are open on it and not on most robots
// returns fewer_open: list of string, elements that are open on most robots and not on it
// order: robot
MATCH (r:Robot) WHERE r.shared IS NULL
CALL (r) {
  MATCH (f:Finding {dismissed: false}) WHERE f.robot = r.name OR f.leak_robot = r.name
  WITH DISTINCT CASE WHEN f.kind = 'disclosure' THEN '' ELSE f.kind + ' ' END
                + CASE WHEN f.pseudonymised THEN 'pseudonymised ' ELSE '' END
                + f.category + ': ' + f.source + CASE f.robot WHEN r.name THEN '' ELSE ' elsewhere' END
                + ' -> ' + f.leak AS finding ORDER BY finding
  RETURN collect(finding) AS findings
}
CALL (r) {
  MATCH (r)<-[:OF_ROBOT]-(e:Element) WHERE size(e.open) > 0
  WITH DISTINCT e.kind + ' ' + e.name + coalesce(' ' + e.leg, '') AS element ORDER BY element
  RETURN collect(element) AS open
}
WITH coalesce(r.model, '') AS model, collect({name: r.name, findings: findings, open: open}) AS robots
CALL (robots) {
  UNWIND robots AS r
  WITH r.findings AS usual_findings, count(*) AS many, min(r.name) AS first  // if equal, the first robot's
  ORDER BY many DESC, first LIMIT 1
  RETURN usual_findings
}
CALL (robots) {
  UNWIND robots AS r
  WITH r.open AS usual_open, count(*) AS many, min(r.name) AS first
  ORDER BY many DESC, first LIMIT 1
  RETURN usual_open
}
UNWIND robots AS r
WITH model, r, usual_findings, usual_open WHERE r.findings <> usual_findings OR r.open <> usual_open
RETURN r.name AS robot, model,
       [x IN r.findings WHERE NOT x IN usual_findings] AS more_findings,
       [x IN usual_findings WHERE NOT x IN r.findings] AS fewer_findings,
       [x IN r.open WHERE NOT x IN usual_open] AS more_open,
       [x IN usual_open WHERE NOT x IN r.open] AS fewer_open
ORDER BY robot
