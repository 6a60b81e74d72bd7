// name: robots
// kind: table
// description: Which robots are loaded, and what is the verdict on each?
// returns robot: string, name of the robot
// returns verdict: string, leak, undetermined or no-leak-found; a DDS domain has none, since data passes there
// returns view: string, declared or enforced
// returns findings: integer, pairs of source and leak that begin or end there, without dismissed ones
// returns dismissed: integer, findings behind another leak of the category only
// returns open: integer, elements that personal data gets to and that no label covers
// returns elements: integer, elements that were loaded
// returns version: integer, how often it was written
// returns part: string, of what is no robot: infrastructure, domain, or fleet for what the fleet file states
// order: robot
MATCH (r:Robot)
CALL (r) {
  MATCH (r)<-[:OF_ROBOT]-(e:Element) WHERE size(e.open) > 0
  RETURN count(DISTINCT e.kind + ' ' + e.name + coalesce(' ' + e.leg, '')) AS open
}
RETURN r.name AS robot, r.verdict AS verdict, r.view AS view,
       COUNT { MATCH (f:Finding) WHERE (f.robot = r.name OR f.leak_robot = r.name) AND NOT f.dismissed } AS findings,
       COUNT { MATCH (f:Finding) WHERE (f.robot = r.name OR f.leak_robot = r.name) AND f.dismissed } AS dismissed,
       open, r.elements AS elements, r.version AS version, r.part AS part
ORDER BY robot
